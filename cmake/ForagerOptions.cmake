# Build options. FORAGER_WITH_* are AUTO features: AUTO uses the library when it is found, ON demands it,
# OFF builds the absent twin, which answers "unsupported" with the package to install.
include(CMakeDependentOption)

option(FORAGER_BUILD_TESTS "Build the tests" ON)
option(FORAGER_BUILD_BENCHMARKS "Build the micro-benchmarks (needs Google Benchmark)" OFF)
option(FORAGER_WERROR "Treat warnings as errors" OFF)
option(FORAGER_FUZZ "Build the libFuzzer targets (clang only)" OFF)
set(FORAGER_SANITIZE "" CACHE STRING "Sanitizers to build with, for example address,undefined")

foreach(feature IN ITEMS CURL SQLITE CRYPTO NANOFLANN HIGHWAY GPIOD MODBUS LIBUSB HIDAPI)
  set(FORAGER_WITH_${feature} AUTO CACHE STRING "Use ${feature}: AUTO, ON or OFF")
  set_property(CACHE FORAGER_WITH_${feature} PROPERTY STRINGS AUTO ON OFF)
endforeach()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# Every target of the project links this: warnings, sanitizers, and no contraction of a*b+c, so that one seed
# gives the same bytes at every optimisation level and on every machine.
add_library(forager_flags INTERFACE)
target_compile_options(forager_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual -Wredundant-decls -Wzero-as-null-pointer-constant
  $<$<CXX_COMPILER_ID:Clang>:-Wreserved-identifier> -ffp-contract=off)
if(FORAGER_WERROR)
  target_compile_options(forager_flags INTERFACE -Werror)
endif()
if(FORAGER_SANITIZE)
  target_compile_options(forager_flags INTERFACE -fsanitize=${FORAGER_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(forager_flags INTERFACE -fsanitize=${FORAGER_SANITIZE})
endif()
# What fuzzers need to see where they have been: every library links this. Tests under the address sanitizer get it
# too, so that both presets share every object.
add_library(forager_coverage INTERFACE)
if(FORAGER_FUZZ OR (FORAGER_SANITIZE MATCHES address AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang"))
  target_compile_options(forager_coverage INTERFACE -fsanitize=fuzzer-no-link)
endif()

# For what is not hot, tests and commands: little optimisation, which compiles in half of the time or less.
add_library(forager_quick_compile INTERFACE)
if(FORAGER_SANITIZE)
  target_compile_options(forager_quick_compile INTERFACE -O0)
else()
  target_compile_options(forager_quick_compile INTERFACE $<$<CONFIG:Release>:-O1>)
endif()

find_program(FORAGER_CCACHE ccache)
if(FORAGER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${FORAGER_CCACHE}")
endif()
