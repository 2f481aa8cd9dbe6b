# Warnings, sanitizers and optimisation, in one target that every target of ours links.

set(OCTASCOPE_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

# Off for users: what a newer compiler warns of must not stop their build. On for developers and CI: in
# all presets but release, and there by deploy/build's environment.
option(OCTASCOPE_WERROR "A warning stops the build" OFF)

add_library(octascope_compiler INTERFACE)
target_compile_options(octascope_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference -Wimplicit-fallthrough
  -Wdouble-promotion -Wformat=2 $<$<BOOL:${OCTASCOPE_WERROR}>:-Werror>)

# clang is used for fuzzing alone: what it warns of beyond gcc is not looked at there.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(octascope_compiler INTERFACE -w)
endif()

if(OCTASCOPE_SANITIZE)
  # The libraries' inlined code trips -Wnull-dereference and -Wmaybe-uninitialized falsely under
  # instrumentation.
  target_compile_options(octascope_compiler INTERFACE
    -fsanitize=${OCTASCOPE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    -Wno-null-dereference -Wno-maybe-uninitialized)
  # Of what is undefined the fuzzers, which read what anybody wrote, look for all. The tests leave out what
  # costs a quarter of their build: the use of null and of what lies past an object is found by its address.
  if(OCTASCOPE_SANITIZE STREQUAL "address,undefined")
    target_compile_options(octascope_compiler INTERFACE
      -fno-sanitize=null,object-size,pointer-overflow,vptr)
  endif()
  target_link_options(octascope_compiler INTERFACE -fsanitize=${OCTASCOPE_SANITIZE})
  target_compile_definitions(octascope_compiler INTERFACE OCTASCOPE_SANITIZED=1)
elseif(CMAKE_BUILD_TYPE STREQUAL "Debug")
  # So do they with little optimisation; the release build looks for both.
  target_compile_options(octascope_compiler INTERFACE -Wno-null-dereference -Wno-maybe-uninitialized)
endif()

# Debug information for useful crash reports, optimised fully.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1 -DNDEBUG")
# The preset dev and the sanitizers'. -O1: the chain runs at a bearable speed, and stacks stay readable.
# -g1: functions and lines; variables (-g) would take a quarter of the compile time.
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1")

# Ten files compiled as one, but in the preset dev: half of the time, most of which went into the same
# headers. There each is compiled alone, so that one edited file is all there is to compile, its own
# includes are known to suffice, and warnings of shadowed names are given where they belong. So it is for
# the fuzzers, which leave files out that others call.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND
   (OCTASCOPE_SANITIZE OR NOT CMAKE_BUILD_TYPE STREQUAL "Debug"))
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)
  target_compile_options(octascope_compiler INTERFACE -Wno-shadow -Wno-subobject-linkage)
endif()

# octascope_compiled_alone(FILES...): never as one with others, because a name of theirs is also one of
# another file's, or because they include themselves once for each instruction set.
function(octascope_compiled_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# One checkout's compiled files serve the next one's: paths are looked at from the source folder, and
# the tests' precompiled headers are known to fit by what is in them.
find_program(OCTASCOPE_CCACHE ccache)
if(OCTASCOPE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1
    CCACHE_SLOPPINESS=pch_defines,time_macros ${OCTASCOPE_CCACHE})
endif()
