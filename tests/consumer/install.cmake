# Installs the library of BUILD into FOLDER/installed and moves that to FOLDER/moved.
file(REMOVE_RECURSE ${FOLDER})
foreach(component library development)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/installed --component ${component}
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${FOLDER}/installed ${FOLDER}/moved)
