# Warnings, sanitizers and optimisation, in one target that every target of ours links.

set(OCTASCOPE_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

add_library(octascope_compiler INTERFACE)
target_compile_options(octascope_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wnull-dereference -Wimplicit-fallthrough
  -Wdouble-promotion -Wformat=2 -Werror)

if(OCTASCOPE_SANITIZE)
  # -O1: the chain runs at a bearable speed, and stacks stay readable. The libraries' inlined
  # code trips -Wnull-dereference and -Wmaybe-uninitialized falsely under instrumentation.
  target_compile_options(octascope_compiler INTERFACE
    -fsanitize=${OCTASCOPE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -O1
    -Wno-null-dereference -Wno-maybe-uninitialized)
  target_link_options(octascope_compiler INTERFACE -fsanitize=${OCTASCOPE_SANITIZE})
  target_compile_definitions(octascope_compiler INTERFACE OCTASCOPE_SANITIZED=1)
endif()

# Debug information for useful crash reports, optimised fully.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O3 -g1 -DNDEBUG")

find_program(OCTASCOPE_CCACHE ccache)
if(OCTASCOPE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${OCTASCOPE_CCACHE})
endif()
