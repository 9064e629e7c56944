# What `cmake --install` puts where, and the Debian packages that `cpack` makes of it:
#   rondure         component program: the program and all that belongs to it
#   librondure-dev  component development: the fits for other C++ programs, find_package(rondure COMPONENTS fit)

set(documents ${PROJECT_BINARY_DIR}/documents)
file(MAKE_DIRECTORY ${documents})
add_custom_command(
  OUTPUT ${documents}/rondure.1.gz ${documents}/rondure.bash ${documents}/changelog.gz ${documents}/changelog.Debian.gz
  COMMAND rondure manual | gzip -9n > rondure.1.gz
  COMMAND rondure completion bash > rondure.bash
  COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > changelog.gz
  COMMAND gzip -9nc ${CMAKE_CURRENT_LIST_DIR}/debian/changelog > changelog.Debian.gz
  DEPENDS rondure ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${CMAKE_CURRENT_LIST_DIR}/debian/changelog
  WORKING_DIRECTORY ${documents} COMMENT "Writing manual page and completion")
add_custom_target(rondure_documents ALL DEPENDS ${documents}/rondure.1.gz)

# ---- the program
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
set(data ${CMAKE_INSTALL_DATADIR}/rondure)
install(TARGETS rondure)
install(FILES ${documents}/rondure.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${documents}/rondure.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME rondure)
install(FILES wire/60-rondure.rules DESTINATION lib/udev/rules.d)
install(FILES ${documents}/changelog.gz ${documents}/changelog.Debian.gz ${CMAKE_CURRENT_LIST_DIR}/debian/copyright
              README.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Beside each other as in the source, so that the examples find schema and points.
install(DIRECTORY plans/examples DESTINATION ${data}/plans)
install(FILES plans/schema/plan.schema.json plans/schema/report.schema.json DESTINATION ${data}/plans/schema)
install(DIRECTORY tests/data/axle_mzc_3 tests/data/nist_cyl_13 DESTINATION ${data}/tests/data)

# ---- the fits for other programs
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/rondure)
set_target_properties(rondure_core PROPERTIES EXPORT_NAME core)
set_target_properties(rondure_fit PROPERTIES EXPORT_NAME fit)
install(TARGETS rondure_core rondure_fit EXPORT rondure)
install(EXPORT rondure FILE rondureTargets.cmake NAMESPACE rondure:: DESTINATION ${config})
install(DIRECTORY core fit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rondure FILES_MATCHING PATTERN "*.h" PATTERN internal EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/core/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rondure/core)
include(CMakePackageConfigHelpers)
write_basic_package_version_file(${documents}/rondureConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/rondureConfig.cmake ${documents}/rondureConfigVersion.cmake
        DESTINATION ${config})
install(FILES ${documents}/changelog.Debian.gz ${CMAKE_CURRENT_LIST_DIR}/debian/copyright
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/librondure-dev)

# ---- cpack
set(CPACK_GENERATOR DEB)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_BINARY_DIR}/generated/package_date.cmake)
set(CPACK_PACKAGE_CONTACT "Rondure developers <developers@rondure.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME rondure)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Loaded where an archive is a server: nothing that is linked tells of it.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libsoci-postgresql4.0")
# Chromium prints report.pdf; everything else works without it.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "chromium, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "fonts-noto-cjk")
# After a first line that CPack takes from the project.
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "A plan in JSON says what to inspect. The program turns the fixture
through poses, drives the probe of a coordinate measuring machine, real or
simulated, finds the minimum-zone cylinder with a proof, and writes a conformance
report whose every digit can be recomputed from the recorded touches.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librondure-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libeigen3-dev, libexpected-dev, libfmt-dev, libceres-dev, libfftw3-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and static libraries of the fits, for C++ programs: circles,
cylinders, spheres and lines by least squares, minimum zone with a global
certificate, minimum circumscribed, maximum inscribed; filters and roundness.")
include(CPack)
