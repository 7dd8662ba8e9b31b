# From DISPERSA_ENGINES, a list of "x86-64 level and lanes": `instances` and `widths_<level>` as C++ reads them.
# It needs nothing else, so that its test runs it by itself (cmake -P).
cmake_minimum_required(VERSION 3.25)
set(instances "")
foreach(engine IN LISTS DISPERSA_ENGINES)
  string(REGEX MATCH "^(v[34]) ([148])$" known "${engine}")
  if(NOT known)
    message(FATAL_ERROR "DISPERSA_ENGINES: '${engine}' is no engine; allowed: v3 or v4 and 1, 4 or 8")
  endif()
  string(APPEND instances " ENGINE(${CMAKE_MATCH_1},${CMAKE_MATCH_2})")
  string(APPEND widths_${CMAKE_MATCH_1} " WIDTH(${CMAKE_MATCH_2})")
endforeach()
# A flight that is watched or alone takes a one-lane engine, and every processor has level v3.
if(NOT "v3 1" IN_LIST DISPERSA_ENGINES)
  message(FATAL_ERROR "DISPERSA_ENGINES: 'v3 1' is missing in '${DISPERSA_ENGINES}'")
endif()
