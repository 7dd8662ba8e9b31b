# `cmake --build build/release && cpack --config build/release/CPackConfig.cmake -G DEB -B OUT`: a Debian package of
# what `cmake --install` installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dispersa)
set(CPACK_PACKAGE_VENDOR dispersa)
set(CPACK_PACKAGE_CONTACT "the dispersa authors <maintainers@dispersa.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "dispersa flies the cases of a campaign, each a six-degree-of-freedom flight with the autopilot in the loop,
in worker processes over DDS, and returns every case's numbers, statistics, and a verdict for each requirement
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
