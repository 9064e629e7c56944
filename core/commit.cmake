# Run in every build: cmake -DGIT=... -DSOURCE=... -DBINARY=... -P commit.cmake writes commit.cpp when the commit has changed.

# The clone may belong to another user, who trusts it by building it. A folder inside somebody else's clone is not ours.
set(git ${GIT} -c safe.directory=* -C ${SOURCE})
execute_process(COMMAND ${git} rev-parse --show-prefix OUTPUT_VARIABLE prefix ERROR_QUIET RESULT_VARIABLE status
                OUTPUT_STRIP_TRAILING_WHITESPACE)
if(status EQUAL 0 AND prefix STREQUAL "")
  execute_process(COMMAND ${git} describe --always --exclude=* --abbrev=12 --dirty=-modified OUTPUT_VARIABLE commit
                  ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
else()
  file(READ ${SOURCE}/core/archived_commit.txt commit LIMIT 12)  # filled in by git archive
endif()
if(NOT commit MATCHES "^[0-9a-f]+(-modified)?$")
  set(commit unknown)
endif()

# Read by cpack: all files of a package are as old as the commit, so that one commit gives one package.
execute_process(COMMAND ${git} log -1 --format=%ct OUTPUT_VARIABLE date ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT status EQUAL 0 OR NOT prefix STREQUAL "")
  file(STRINGS ${SOURCE}/core/archived_commit.txt lines)
  list(GET lines 1 date)
endif()
set(package_date)
if(date MATCHES "^[0-9]+$")
  set(package_date "if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})\n  set(ENV{SOURCE_DATE_EPOCH} ${date})\nendif()\n")
endif()
file(CONFIGURE OUTPUT ${BINARY}/generated/package_date.cmake CONTENT "${package_date}")

configure_file(${SOURCE}/core/commit.cpp.in ${BINARY}/generated/core/commit.cpp @ONLY)
