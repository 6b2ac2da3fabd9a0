# takt_unite(LIST NAME): with TAKT_UNITY, replaces the test files (*_test.cpp) of the list variable LIST by generated files,
# each of which has several test files. GCC then needs a third of the time, because it instantiates each template of the standard
# library, of GoogleTest and of takt once for all these files.
function(takt_unite united_list name)
  if(NOT TAKT_UNITY)
    return()
  endif()
  set(singles ${${united_list}})
  list(FILTER singles EXCLUDE REGEX "_test\\.cpp$")
  set(tests ${${united_list}})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  set(group_size 16)  # the number of files that a compiler reads with at most 1 GB of memory
  set(united)
  list(LENGTH tests left)
  while(left GREATER 0)
    list(SUBLIST tests 0 ${group_size} group)
    list(LENGTH united number)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/united/${name}_${number}.cpp)
    set(unite ${PROJECT_SOURCE_DIR}/share/cmake/unite.py)
    add_custom_command(OUTPUT ${file} COMMAND ${Python3_EXECUTABLE} ${unite} ${file} ${group} DEPENDS ${unite} ${group}
                       COMMENT "")
    list(APPEND united ${file})
    if(left LESS_EQUAL group_size)
      break()
    endif()
    list(SUBLIST tests ${group_size} -1 tests)
    list(LENGTH tests left)
  endwhile()
  set_property(GLOBAL APPEND PROPERTY TAKT_UNITED ${united})
  set(${united_list} ${singles} ${united} PARENT_SCOPE)
endfunction()

# takt_united(): the target of all generated files. This target depends on nothing, so no generated file waits for a library.
function(takt_united)
  get_property(united GLOBAL PROPERTY TAKT_UNITED)
  add_custom_target(takt_united DEPENDS ${united})
endfunction()
