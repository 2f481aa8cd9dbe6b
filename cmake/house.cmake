# octascope_house(NAME FOLDER <folder> [SUBFOLDERS <folders>] SOURCES <files>
#                 USES <targets> [PRIVATE_USES <targets>])
#
# One folder of the house as the static library octascope_NAME. Its headers are visible, as
# "<folder>/<file>.h", only to those that name it in USES: each house gets an include root of its
# own in the build tree that holds nothing but links to its headers, so that an include against the
# arrows of ARCHITECTURE.md finds no file and the build stops. tests/architecture proves it.
function(octascope_house name)
  cmake_parse_arguments(HOUSE "" "FOLDER" "SUBFOLDERS;SOURCES;USES;PRIVATE_USES" ${ARGN})

  set(source_folder ${CMAKE_SOURCE_DIR}/${HOUSE_FOLDER})
  set(include_root ${CMAKE_BINARY_DIR}/houses/${name})
  set(patterns ${source_folder}/*.h)
  foreach(subfolder IN LISTS HOUSE_SUBFOLDERS)
    list(APPEND patterns ${source_folder}/${subfolder}/*.h)
  endforeach()
  file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${source_folder} ${patterns})
  file(REMOVE_RECURSE ${include_root})
  foreach(header IN LISTS headers)
    get_filename_component(link ${include_root}/${HOUSE_FOLDER}/${header} ABSOLUTE)
    get_filename_component(link_folder ${link} DIRECTORY)
    file(MAKE_DIRECTORY ${link_folder})
    file(CREATE_LINK ${source_folder}/${header} ${link} SYMBOLIC)
  endforeach()

  add_library(octascope_${name} STATIC ${HOUSE_SOURCES})
  if(HOUSE_FOLDER MATCHES "^hal") # few files each: nothing is gained by compiling them as one
    set_target_properties(octascope_${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  target_include_directories(octascope_${name} PUBLIC ${include_root})
  target_link_libraries(octascope_${name} PUBLIC ${HOUSE_USES}
                                          PRIVATE ${HOUSE_PRIVATE_USES} octascope_compiler)
endfunction()
