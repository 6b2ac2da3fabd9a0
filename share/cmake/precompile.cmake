# takt_precompile(TARGET OWNER HEADERS...): parses HEADERS once, for OWNER and for all targets that name it; these have equal
# flags. Sources include what they use all the same.
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
  add_compile_options(-pthread)  # LCM asks for it; it has to be the same everywhere
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 takes a precompiled header for no system header and warns of what it sees wrongly inside std::string and
    # std::optional (bug 105651).
    add_compile_options(-Wno-stringop-overflow -Wno-array-bounds -Wno-maybe-uninitialized)
  else()
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")  # or ccache takes every precompiled header for a new one
  endif()
  if(CCACHE)  # caches sources behind a precompiled header only when told so
    set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  endif()
endif()
