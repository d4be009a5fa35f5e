# cmake -DOUT=file.cc -DVERSION=0.1.0 -DSOURCES=folder -P build_id.cmake: BuildId() of the checkout as it is now. The file
# is written only where that has changed, so that a build of the same sources has nothing to do.
set(id "unknown")
if(EXISTS "${SOURCES}/.git")
  # Built by root from another user's checkout, git would refuse to look.
  execute_process(COMMAND git --no-optional-locks -c safe.directory=* -C "${SOURCES}" describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE found RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(failed EQUAL 0)
    set(id "${found}")
  endif()
endif()
set(code "// Made by eval/output/build_id.cmake.\n#include \"eval/output/build_id.h\"\n\nnamespace depthgrid {\n")
string(APPEND code "std::string BuildId() { return \"${id}\"; }\n")
string(APPEND code "std::string VersionText() { return \"${VERSION} (${id})\"; }\n}  // namespace depthgrid\n")
set(there "")
if(EXISTS "${OUT}")
  file(READ "${OUT}" there)
endif()
if(NOT there STREQUAL code)
  file(WRITE "${OUT}" "${code}")
endif()
