# Sourced by run.sh, test.sh and benchmarks/run.sh: what must be installed on Debian 12, and how it gets there.
# Nothing else is used: neither CMake nor the scripts look for what a machine happens to have.

# git names the commit in rondure --version. Boost: distributions (headers only), and SOCI's headers
# include it.
rondure_build_packages="g++ cmake ninja-build git gettext libeigen3-dev nlohmann-json3-dev libexpected-dev libcli11-dev libfmt-dev
  libasio-dev libsoci-dev libpq-dev libboost-dev libsqlite3-dev libssl-dev libfftw3-dev libcgal-dev
  pkg-config libusb-1.0-0-dev libceres-dev libpugixml-dev libcpp-httplib-dev"
# The tests are compiled with the libraries and start the programs.
rondure_test_libraries="libgtest-dev libgmock-dev libumockdev-dev"
rondure_test_programs="python3-jsonschema postgresql openssl umockdev libxml2-utils dpkg-dev lintian"
rondure_browser_packages="chromium nodejs npm fonts-dejavu-core fonts-noto-cjk poppler-utils"
rondure_benchmark_packages="libbenchmark-dev libnlopt-cxx-dev libalglib-dev python3"
rondure_fuzz_packages="clang-14 libclang-rt-14-dev"

# The first lines of a log that say why something failed, or its last ones; then where the whole log lies.
explain_failure() {  # LOG PATTERN
  if grep -qi 'no space left on device' "$1"; then
    echo "The disk is full. Free some space and start again; the next call goes on from here." >&2
  fi
  { grep -m 1 -A 4 -E "$2" "$1" || tail -n 12 "$1"; } >&2
  echo "The whole log: $1" >&2
}

# A log file with a name that nobody can guess.
new_log() {
  mktemp "${TMPDIR:-/tmp}/rondure-$1.XXXXXXXX" || {
    echo "No log file can be made in ${TMPDIR:-/tmp}: see whether the disk is full or TMPDIR is wrong." >&2
    return 2
  }
}

# Reads lines "PERCENT TEXT". On a terminal they take turns in one line, elsewhere there is a line every 10 %.
show_progress() {
  local percent text told=-10
  while read -r percent text; do
    if [ -t 2 ]; then
      printf '\r\033[K%.79s' "$text" >&2
    elif [ "$percent" -ge $((told + 10)) ] || [ "$percent" -lt "$told" ]; then
      told=$((percent / 10 * 10))
      printf '%s\n' "$text" >&2
    fi
  done
  [ ! -t 2 ] || printf '\r\033[K' >&2
}

# What dpkg has: names of installed packages and what they provide.
installed_packages() {
  dpkg-query -W -f='${db:Status-Status} ${Package}\n${db:Status-Status} ${Provides}\n' 2>/dev/null |
    sed -n 's/^installed //p' | sed 's/([^)]*)//g' | tr -d ',' | tr ' ' '\n'
}

# ensure_packages NAME...: installs what is missing as root or through sudo; otherwise says which one command to run.
# Ends the script where packages are missing and cannot be had.
ensure_packages() {
  local missing="" name installed sudo="" log count
  installed=$(installed_packages)
  for name in "$@"; do
    grep -qxF "$name" <<<"$installed" || [[ " $missing " == *" $name "* ]] || missing+=" $name"
  done
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    sudo=sudo
    if ! command -v sudo >/dev/null || { [ ! -t 0 ] && ! sudo -n true 2>/dev/null; }; then
      echo "These Debian packages are missing; install them and start again:" >&2
      echo "  apt-get install --no-install-recommends$missing" >&2
      exit 2
    fi
  fi
  log=$(new_log packages) || exit 2
  count=$(wc -w <<<"$missing")
  echo "Installing $count Debian packages and what they need:$missing" | fold -s -w 79 >&2
  # Finishes what an earlier call left half done. A package list may name files that are no longer there, so it is
  # fetched first; where only some other source fails, installing may still work, and decides.
  local proxies apt="apt-get -q -o DPkg::Lock::Timeout=300"
  proxies=$(env | grep -iE '^(https?|no)_proxy=' || true)  # sudo keeps none
  if ! {
    $sudo env DEBIAN_FRONTEND=noninteractive dpkg --configure -a </dev/null
    $sudo env DEBIAN_FRONTEND=noninteractive $proxies $apt update </dev/null
    $sudo env DEBIAN_FRONTEND=noninteractive $proxies $apt -o APT::Status-Fd=1 install -y --no-install-recommends $missing </dev/null
  } 2>&1 | tee -a "$log" |
    sed -un 's/^dlstatus:[^:]*:\([0-9]*\)[^:]*:.*/\1 Downloading packages: \1 %/p
             s/^pmstatus:\([^:]*\):\([0-9]*\)[^:]*:.*/\2 Installing packages: \2 % (\1)/p' | show_progress; then
    echo "Installing failed; nothing was built. Start again when the cause is gone; what was downloaded is kept." >&2
    explain_failure "$log" '^(E|Err)[:0-9]'
    exit 2
  fi
  rm -f "$log"
}

# build PRESET TESTING TARGET...: configures when needed, builds with a line of progress; the first error when it fails.
build() {
  local preset=$1 testing=$2 log
  shift 2
  log=$(new_log build) || exit 2
  # What --full adds is configured only where it is asked for, and stays away afterwards.
  local full=OFF cache=build/$preset/CMakeCache.txt
  [ -z "${RONDURE_FULL:-}" ] || [ "$preset" != release ] || full=ON
  if [ ! -f "build/$preset/build.ninja" ] || [ CMakePresets.json -nt "build/$preset/build.ninja" ] ||
    { [ "$testing" = ON ] && ! { grep -q '^BUILD_TESTING:BOOL=ON' "$cache" && grep -q "^RONDURE_FULL:BOOL=$full" "$cache"; }; }; then
    cmake --preset "$preset" -DBUILD_TESTING="$testing" -DRONDURE_FULL="$full" >"$log" 2>&1 || {
      echo "Configuring the build failed:" >&2
      explain_failure "$log" 'CMake Error'
      exit 2
    }
  fi
  local start=$SECONDS
  # Huge pages for the compiler: 1 to 5 % of its time.
  if ! GLIBC_TUNABLES=glibc.malloc.hugetlb=1 NINJA_STATUS='[%f/%t] ' \
    cmake --build --preset "$preset" --target "$@" 2>&1 | tee -a "$log" |
    sed -un '/Re-running CMake/d; s,^\[\([0-9]*\)/\([0-9]*\)\] .*,\1 \2,p' | build_progress "$preset" "$start" |
    show_progress; then
    echo "The build failed. The first error:" >&2
    explain_failure "$log" 'error: |undefined reference to|cannot find -l|Killed'
    exit 2
  fi
  rm -f "$log"
}

# Reads lines "DONE TOTAL" of ninja. Builds of less than two seconds stay silent; the first tenth foretells nothing.
build_progress() {  # PRESET START
  local done total left percent
  while read -r done total; do
    left=$(((SECONDS - $2) * (total - done) / done)) percent=$((100 * done / total))
    [ $((SECONDS - $2)) -ge 2 ] || continue
    [ "$left" -ge 60 ] && left=", about $(((left + 30) / 60)) min left" || left=", less than 1 min left"
    [ "$percent" -ge 10 ] || left=""
    echo "$percent Building $1: [$done/$total] $percent %$left"
  done
}

# What Ctrl-C means, for the scripts that source this.
trap 'echo >&2; echo "Stopped. The next call goes on from here." >&2; exit 130' INT
