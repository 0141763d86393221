# Installs the libraries into a fresh folder; builds and runs a program there that finds them in no other place.
#
#   BUILD, SOURCE, FOLDER   the build to install from, the program's folder, where to work
#   COMPILER, GENERATOR     as the build has them
file(REMOVE_RECURSE ${FOLDER})
foreach(command
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${FOLDER}/installed;--component;development"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${FOLDER}/build;-G;${GENERATOR};-DCMAKE_CXX_COMPILER=${COMPILER};-DCMAKE_PREFIX_PATH=${FOLDER}/installed"
    "${CMAKE_COMMAND};--build;${FOLDER}/build"
    "${FOLDER}/build/consumer")
  execute_process(COMMAND ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
