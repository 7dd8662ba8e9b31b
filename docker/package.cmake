# `cmake --build build/release && cpack --config build/release/CPackConfig.cmake -G DEB -B OUT`: a Debian package of
# what `cmake --install` installs.
set(CPACK_GENERATOR DEB)
# A build without the service packs `dispersa-engine`. What a build with it adds beside that one is `dispersa-cluster`
# (CPackClusterConfig.cmake); the package `dispersa` is both.
if(DISPERSA_SERVICE)
  set(CPACK_PACKAGE_NAME dispersa)
  set(CPACK_DEBIAN_PACKAGE_CONFLICTS "dispersa-engine, dispersa-cluster")
else()
  set(CPACK_PACKAGE_NAME dispersa-engine)
  set(CPACK_DEBIAN_PACKAGE_CONFLICTS dispersa)
endif()
set(CPACK_PACKAGE_VENDOR dispersa)
set(CPACK_PACKAGE_CONTACT "the dispersa authors <maintainers@dispersa.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "dispersa flies the cases of a campaign, each a six-degree-of-freedom flight with the autopilot in the loop,
on this machine's cores or over a cluster, and returns every case's numbers, statistics, and a verdict for each requirement
with the risk that it is wrong. The processor must be x86-64-v3.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The Python package, if it was built, gives arrays, tables and plots.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-numpy, python3-pandas, python3-matplotlib")
# Never as the account of whoever packs.
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)

if(DISPERSA_SERVICE)
  # The programs once more: the package's `dispersa` hands over to this one (services/cli/main.cc).
  install(PROGRAMS "$<TARGET_FILE:dispersa>" DESTINATION "${CMAKE_INSTALL_BINDIR}" RENAME dispersa-fleet
          COMPONENT cluster EXCLUDE_FROM_ALL)
  install(TARGETS dispersa-coordinator dispersa-worker dispersa-foreign COMPONENT cluster EXCLUDE_FROM_ALL)
  install(DIRECTORY services/deploy DESTINATION "${data}" USE_SOURCE_PERMISSIONS COMPONENT cluster EXCLUDE_FROM_ALL)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/CPackClusterConfig.cmake" @ONLY CONTENT [[
include("@PROJECT_BINARY_DIR@/CPackConfig.cmake")
set(CPACK_PACKAGE_NAME dispersa-cluster)
set(CPACK_INSTALL_CMAKE_PROJECTS "@PROJECT_BINARY_DIR@;@PROJECT_NAME@;cluster;/")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "dispersa-engine (= @PROJECT_VERSION@)")
set(CPACK_DEBIAN_PACKAGE_CONFLICTS dispersa)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "")
]])
endif()
