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
configure_file(${SOURCE}/core/commit.cpp.in ${BINARY}/generated/core/commit.cpp @ONLY)
