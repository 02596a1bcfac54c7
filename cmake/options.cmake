option(ABBE_WERROR "Treat warnings as errors" OFF)
option(ABBE_SANITIZE "Build with the address and undefined-behaviour sanitizers" OFF)
option(ABBE_HARDEN "Fortified libc calls, stack protectors, and a program that is position-independent \
and whose tables are read-only once it runs" ON)
option(ABBE_TESTS "Build the tests" ON)
option(ABBE_FUZZ "Link the fuzz targets with libFuzzer (clang only)" OFF)

set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# What every room compiles with.
add_library(abbe_build INTERFACE)
target_include_directories(abbe_build INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
target_compile_definitions(abbe_build INTERFACE _POSIX_C_SOURCE=200809L)
target_compile_options(abbe_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wvla
  $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes;-Wmissing-prototypes>
  # a product of floats must round the same in every build: fused multiply-add is never implied
  -ffp-contract=off
  $<$<BOOL:${ABBE_WERROR}>:-Werror>)
if(ABBE_SANITIZE)
  target_compile_options(abbe_build INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    # GCC's goes by the ranges of numbers, which it follows from -O2 on
    $<$<C_COMPILER_ID:GNU>:-Wno-format-truncation>)
  target_link_options(abbe_build INTERFACE -fsanitize=address,undefined)
endif()

if(ABBE_FUZZ)
  target_compile_options(abbe_build INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(abbe_build INTERFACE -fsanitize=fuzzer-no-link)
endif()

if(ABBE_HARDEN)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES C CXX)
  target_compile_options(abbe_build INTERFACE -fstack-protector-strong)
  target_link_options(abbe_build INTERFACE LINKER:-z,relro LINKER:-z,now)
  if(NOT ABBE_SANITIZE) # whose own checks the fortified calls would hide
    target_compile_options(abbe_build INTERFACE
      $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>)
  endif()
endif()

include(${CMAKE_CURRENT_LIST_DIR}/embed.cmake)

# A caller's thread may have a small stack. The sanitizers' frames are larger by what they watch.
set(abbe_frames "")
if(NOT ABBE_SANITIZE)
  set(abbe_frames -Wframe-larger-than=49152)
endif()

# abbe_room(NAME SOURCES… LIBRARIES…): one room of the library, as objects.
function(abbe_room name)
  cmake_parse_arguments(room "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(abbe_${name} OBJECT ${room_SOURCES})
  target_link_libraries(abbe_${name} PUBLIC abbe_build ${room_LIBRARIES})
  target_compile_options(abbe_${name} PRIVATE ${abbe_frames})
  set_property(GLOBAL APPEND PROPERTY ABBE_ROOMS abbe_${name})
endfunction()
