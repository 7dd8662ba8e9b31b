# From DISPERSA_ENGINES, a list of "x86-64 level and lanes": `instances` and `widths_<level>` as C++ reads them.
# It needs nothing else, so that its test runs it by itself (cmake -P).
cmake_minimum_required(VERSION 3.25)
set(instances "")
set(levels "")
foreach(engine IN LISTS DISPERSA_ENGINES)
  string(REGEX MATCH "^(v[34]) ([148])$" known "${engine}")
  if(NOT known)
    message(FATAL_ERROR "DISPERSA_ENGINES: '${engine}' is no engine; allowed: v3 or v4 and 1, 4 or 8")
  endif()
  list(APPEND levels "${CMAKE_MATCH_1}")
  string(APPEND instances " ENGINE(${CMAKE_MATCH_1},${CMAKE_MATCH_2})")
  string(APPEND widths_${CMAKE_MATCH_1} " WIDTH(${CMAKE_MATCH_2})")
endforeach()
# A flight that is watched or alone takes the one-lane engine of its level, and every processor has level v3.
list(APPEND levels v3)
list(REMOVE_DUPLICATES levels)
foreach(level IN LISTS levels)
  if(NOT "${level} 1" IN_LIST DISPERSA_ENGINES)
    message(FATAL_ERROR "DISPERSA_ENGINES: '${level} 1' is missing in '${DISPERSA_ENGINES}'; "
                        "needed: 'v3 1', and 'v4 1' beside other engines of v4")
  endif()
endforeach()
