# Installs the COMPONENTS of BUILD into FOLDER/installed and moves that to FOLDER/moved.
file(REMOVE_RECURSE ${FOLDER})
foreach(component IN LISTS COMPONENTS)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${FOLDER}/installed --component ${component}
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${FOLDER}/installed ${FOLDER}/moved)
