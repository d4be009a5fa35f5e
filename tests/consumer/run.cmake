# Installs the build at BUILD into a scratch folder, builds the consumer against it and runs it: once with all rooms that
# are installed, once with the mapper alone.
set(scratch ${BUILD}/consumer)
file(REMOVE_RECURSE ${scratch})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code)
  if(code)
    message(FATAL_ERROR "${ARGN} failed with ${code}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${scratch}/tree)
# Headers name pages of the documentation; they are installed, too.
file(GLOB_RECURSE headers ${scratch}/tree/include/*.h)
foreach(header ${headers})
  file(STRINGS ${header} lines REGEX "docs/[a-z_/]+\\.(md|cc)")
  foreach(line ${lines})
    string(REGEX MATCHALL "docs/[a-z_/]+\\.(md|cc)" pages "${line}")
    foreach(page ${pages})
      if(NOT EXISTS ${scratch}/tree/share/doc/depthgrid/${page})
        message(FATAL_ERROR "${header} names ${page}, which is not installed")
      endif()
    endforeach()
  endforeach()
endforeach()
# consume(NAME [option...]): configures, builds and runs it.
function(consume name)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${scratch}/${name} -G Ninja -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" -DCMAKE_PREFIX_PATH=${scratch}/tree ${ARGN})
  run(${CMAKE_COMMAND} --build ${scratch}/${name})
  run(${scratch}/${name}/consumer)
endfunction()
consume(whole)
# A robot that links the mapper alone need not have what reads files.
consume(mapper_alone -DWITH_FILES=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON -DCMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON
  -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON)
