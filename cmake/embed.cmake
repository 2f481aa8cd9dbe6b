# octascope_embed(TARGET NAMESPACE HEADER FILES...)
#
# Puts files into the program, so that it needs nothing beside it. Those that link TARGET may include
# HEADER (as written), which declares one std::string_view per file, named after it
# (stack.frag → stack_frag).
function(octascope_embed target namespace header)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded/${header})
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DNAMESPACE=${namespace} "-DFILES=${ARGN}"
            -P ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    DEPENDS ${ARGN} ${CMAKE_SOURCE_DIR}/cmake/embed_files.cmake
    COMMENT "Embedding into ${header}" VERBATIM)
  add_custom_target(${target}_file DEPENDS ${output})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_file)
  target_include_directories(${target} INTERFACE ${CMAKE_CURRENT_BINARY_DIR}/embedded)
endfunction()
