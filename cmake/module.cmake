# octascope_module(<folder> SOURCES <files> [NAME <name>] [USES <targets>] [PRIVATE_USES <targets>])
#
# One folder as a static library of its own, named after it: pipeline/scan is octascope_pipeline_scan.
# Its headers are visible, as "<folder>/<file>.h", only to those that name it in USES: each module gets
# an include root in the build tree that holds nothing but links to its headers, so that an include
# against the arrows of ARCHITECTURE.md finds no file and the build stops. tests/architecture proves it.
function(octascope_module folder)
  cmake_parse_arguments(MODULE "" "NAME" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  if(NOT MODULE_NAME)
    string(MAKE_C_IDENTIFIER ${folder} MODULE_NAME)
  endif()

  set(source_folder ${CMAKE_SOURCE_DIR}/${folder})
  set(include_root ${CMAKE_BINARY_DIR}/modules/${MODULE_NAME})
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${source_folder} ${source_folder}/*.h)
  file(REMOVE_RECURSE ${include_root})
  file(MAKE_DIRECTORY ${include_root}/${folder})
  foreach(header IN LISTS headers)
    file(CREATE_LINK ${source_folder}/${header} ${include_root}/${folder}/${header} SYMBOLIC)
  endforeach()

  set(target octascope_${MODULE_NAME})
  add_library(${target} STATIC ${MODULE_SOURCES})
  if(folder MATCHES "^hal") # few files each: nothing is gained by compiling them as one
    set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  endif()
  target_include_directories(${target} PUBLIC ${include_root})
  target_link_libraries(${target} PUBLIC ${MODULE_USES}
                                  PRIVATE ${MODULE_PRIVATE_USES} octascope_compiler)
  # What works hard is below; this takes the compiler long. What measures is optimised as what it measures.
  if(OCTASCOPE_SANITIZE AND folder MATCHES "^firmware-host")
    target_compile_options(${target} PRIVATE -O0)
  elseif(folder MATCHES "^firmware-host/commands" AND NOT folder MATCHES "/bench")
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# octascope_modules(<name> <targets>): several modules under one name, for those who use them all.
function(octascope_modules name)
  add_library(octascope_${name} INTERFACE)
  target_link_libraries(octascope_${name} INTERFACE ${ARGN})
endfunction()
