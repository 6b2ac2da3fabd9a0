# takt_precompile(TARGET OWNER HEADERS...): parses HEADERS once, for OWNER and for all targets that name OWNER. These targets
# have equal flags. Sources still include every header that they use.
function(takt_precompile target owner)
  if(NOT TAKT_PCH)
    return()
  elseif(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

set(TAKT_STD_HEADERS <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstddef> <cstdint> <cstring>
                     <expected> <functional> <limits> <map> <memory> <optional> <span> <string> <string_view> <tuple>
                     <utility> <variant> <vector>)
set(TAKT_PCH_OWNER takt_table)

if(TAKT_PCH)
  add_compile_options(-pthread)  # LCM needs this option; it has to be the same in all targets
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 does not treat a precompiled header as a system header, and prints false warnings about std::string and std::optional
    # (bug 105651).
    add_compile_options(-Wno-stringop-overflow -Wno-array-bounds -Wno-maybe-uninitialized)
  else()
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")  # otherwise ccache regards every precompiled header as new
  endif()
  if(CCACHE)  # ccache caches sources with a precompiled header only with this setting
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  endif()
endif()
