# engine_sources(ROOT OUT [GLOB_OPTION...]): the sources under ROOT that decide the result of a case, as
# sorted paths relative to ROOT. Statistics and reports only read results.
function(engine_sources root out)
  set(patterns "")
  foreach(module IN ITEMS math input expressions random environment vehicle structure modes control dynamics guidance flight optimization trajectory
          campaign campaign_yaml containment cases)
    list(APPEND patterns "${root}/core/${module}/*.h" "${root}/core/${module}/*.cc")
  endforeach()
  file(GLOB_RECURSE sources LIST_DIRECTORIES false RELATIVE "${root}" ${ARGN} ${patterns})
  list(SORT sources COMPARE STRING CASE SENSITIVE ORDER ASCENDING)
  set(${out} "${sources}" PARENT_SCOPE)
endfunction()
