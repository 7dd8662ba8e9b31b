# What `cmake --install` installs besides the programs, wherever the tree is moved afterwards: programs look for each
# other and for the campaigns beside themselves.
include(GNUInstallDirs)
set(data "${CMAKE_INSTALL_DATADIR}/dispersa")

# Everything that campaigns name, whatever its kind. `run` builds a repository.
install(DIRECTORY campaigns DESTINATION "${data}" USE_SOURCE_PERMISSIONS
  PATTERN run EXCLUDE
  PATTERN reference.csv EXCLUDE  # what optimize leaves
  PATTERN reference.html EXCLUDE)
if(DISPERSA_SERVICE)
  install(DIRECTORY services/deploy DESTINATION "${data}" USE_SOURCE_PERMISSIONS)
endif()
install(FILES core/analysis/summary.schema.json DESTINATION "${data}/schemas")

# Each README.md in its folder, so that their links lead somewhere.
file(GLOB_RECURSE documents RELATIVE "${PROJECT_SOURCE_DIR}" CONFIGURE_DEPENDS
  core/*.md services/*.md idl/*.md docker/*.md core/images/* campaigns/*.md services/docs/pages/images/*)
list(FILTER documents EXCLUDE REGEX "services/cli/starter/")  # what `init` writes
foreach(document IN LISTS documents ITEMS README.md CONTRIBUTING.md CHANGELOG.md CITATION.cff SECURITY.md LICENSE)
  get_filename_component(folder "${document}" DIRECTORY)
  install(FILES "${document}" DESTINATION "${CMAKE_INSTALL_DOCDIR}/${folder}")
endforeach()
install(FILES docker/debian/copyright DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# Completion. Where zsh looks depends on who installs: a package of Debian, or somebody below /usr/local.
set(completion services/cli/completion)
set(programs dispersa)
if(DISPERSA_SERVICE)
  list(APPEND programs dispersa-coordinator dispersa-worker)
endif()
foreach(program IN LISTS programs)
  install(FILES ${completion}/dispersa.bash RENAME ${program}
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
  install(FILES ${completion}/dispersa.fish RENAME ${program}.fish
    DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
endforeach()
install(CODE "set(zsh_folder site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
    set(zsh_folder vendor-completions)
  endif()
  file(INSTALL \"${PROJECT_SOURCE_DIR}/${completion}/dispersa.zsh\" RENAME _dispersa
       DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${zsh_folder}\")")

# Man pages are made by running the programs. They belong to a whole build, not to `programs`, which is what flies.
find_program(HELP2MAN help2man)
set(manual "${PROJECT_BINARY_DIR}/manual")
if(HELP2MAN)
  add_custom_command(OUTPUT "${manual}/dispersa.1.gz"
    COMMAND docker/manual "${CMAKE_RUNTIME_OUTPUT_DIRECTORY}" "${manual}"
    DEPENDS ${programs} docker/manual docker/manual.h2m
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" COMMENT "Making the man pages" VERBATIM)
  add_custom_target(manual ALL DEPENDS "${manual}/dispersa.1.gz")
else()
  message(STATUS "help2man is not installed: no man pages")
endif()
install(DIRECTORY "${manual}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
