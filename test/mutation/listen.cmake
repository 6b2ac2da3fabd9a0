# Included by the project that mutate.py configures, right after project(): adds the listener to the test programs
# TAKT_LISTENING, which exist when the top folder has been read. They compile longer than they run.
function(takt_listen)
  foreach(program IN LISTS TAKT_LISTENING)
    target_sources(${program} PRIVATE ${CMAKE_SOURCE_DIR}/test/mutation/reach_listener.cpp)
    target_compile_options(${program} PRIVATE -O0)
  endforeach()
endfunction()
cmake_language(DEFER DIRECTORY ${CMAKE_SOURCE_DIR} CALL takt_listen)
