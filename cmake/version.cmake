# Generates the module `version` in the build folder, anew whenever the commit changes.
# Included by CMakeLists.txt it declares the target; run as a script (cmake -P) it writes the file.

if(CMAKE_SCRIPT_MODE_FILE)
  execute_process(COMMAND git describe --tags --always --dirty
    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE commit ERROR_QUIET RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(status EQUAL 0 AND NOT commit STREQUAL "")
    set(VERSION_STRING "${PROJECT_VERSION} (${commit})")
  else()
    set(VERSION_STRING "${PROJECT_VERSION}")
  endif()
  configure_file(${SOURCE_DIR}/cmake/version.f90.in ${OUTPUT} @ONLY) # leaves the file alone when nothing changed
  return()
endif()

set(version_source ${PROJECT_BINARY_DIR}/version.f90)
set(version_command ${CMAKE_COMMAND}
  -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${version_source} -DPROJECT_VERSION=${PROJECT_VERSION}
  -DBUILD_TYPE=${CMAKE_BUILD_TYPE} "-DCOMPILER=${CMAKE_Fortran_COMPILER_ID} ${CMAKE_Fortran_COMPILER_VERSION}"
  -DDATA_DIRECTORY=${CMAKE_INSTALL_FULL_DATADIR}/brisance
  -P ${CMAKE_CURRENT_LIST_FILE})
execute_process(COMMAND ${version_command})
add_custom_target(version COMMAND ${version_command} BYPRODUCTS ${version_source} COMMENT "Checking the version" VERBATIM)
if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  set_source_files_properties(${version_source} PROPERTIES COMPILE_OPTIONS -ffree-line-length-none) # paths can be long
endif()
