# Sourced by run.sh and test.sh: what must be installed on Debian 12, and how it gets there.

# libboost-dev: SOCI's headers include Boost, its package does not depend on it.
rondure_build_packages="g++ cmake ninja-build libeigen3-dev nlohmann-json3-dev libexpected-dev libcli11-dev libfmt-dev
  libasio-dev libsoci-dev libboost-dev libsqlite3-dev libssl-dev libfftw3-dev libcgal-dev
  pkg-config libusb-1.0-0-dev libceres-dev libpugixml-dev libcpp-httplib-dev libcairo2-dev libpango1.0-dev
  librsvg2-dev fonts-dejavu-core"
rondure_test_packages="libgtest-dev libgmock-dev python3-jsonschema postgresql openssl libumockdev-dev umockdev
  libxml2-utils poppler-utils fonts-noto-cjk"
# Debian's npm brings some 390 packages: a Node that is there already is good enough.
rondure_browser_packages="chromium fonts-dejavu-core poppler-utils"
command -v node >/dev/null || rondure_browser_packages+=" nodejs"
command -v npm >/dev/null || rondure_browser_packages+=" npm"
rondure_benchmark_packages="libbenchmark-dev libnlopt-cxx-dev libalglib-dev python3"

# ensure_packages NAME...: installs what is missing as root or through sudo; otherwise says which
# one command to run, and ends.
ensure_packages() {
  local missing="" name
  local installed
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' 2>/dev/null | sed -n 's/ installed$//p')
  for name in "$@"; do
    grep -qxF "$name" <<<"$installed" || missing+=" $name"
  done
  [ -z "$missing" ] && return 0
  local sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    if sudo -n true 2>/dev/null || { [ -t 0 ] && command -v sudo >/dev/null; }; then
      sudo=sudo
    else
      echo "These Debian packages are missing; install them and start again:" >&2
      echo "  apt-get install --no-install-recommends$missing" >&2
      exit 2
    fi
  fi
  echo "Installing$missing"
  # An old package list names files that are no longer there, so it is fetched once before.
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get -q update &&
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends $missing || {
    echo "Installing failed; see the messages above. Nothing was built." >&2
    exit 2
  }
}

# build PRESET TESTING TARGET...: configures when needed, builds quietly, shows the log when it fails.
build() {
  local preset=$1 testing=$2
  shift 2
  if [ ! -f "build/$preset/build.ninja" ] ||
    { [ "$testing" = ON ] && ! grep -q '^BUILD_TESTING:BOOL=ON' "build/$preset/CMakeCache.txt"; }; then
    cmake --preset "$preset" -DBUILD_TESTING="$testing" >"/tmp/rondure-configure.$$" 2>&1 || {
      cat "/tmp/rondure-configure.$$" >&2
      exit 2
    }
    rm -f "/tmp/rondure-configure.$$"
  fi
  cmake --build --preset "$preset" --target "$@"
}
