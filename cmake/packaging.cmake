# What is installed, and the Debian package that deploy/package makes of it. All paths are written
# out below the root: a service's files have one place each.

set(OCTASCOPE_DEPLOY ${CMAKE_SOURCE_DIR}/deploy)
set(OCTASCOPE_DOC usr/share/doc/octascope)

install(TARGETS octascope RUNTIME DESTINATION usr/bin)
install(PROGRAMS ${OCTASCOPE_DEPLOY}/back-off DESTINATION usr/lib/octascope)
install(FILES ${OCTASCOPE_DEPLOY}/octascope.service DESTINATION lib/systemd/system)
install(FILES ${OCTASCOPE_DEPLOY}/70-octascope.rules DESTINATION lib/udev/rules.d)
install(FILES ${OCTASCOPE_DEPLOY}/octascope.sysusers DESTINATION usr/lib/sysusers.d RENAME octascope.conf)
install(FILES ${OCTASCOPE_DEPLOY}/octascope.tmpfiles DESTINATION usr/lib/tmpfiles.d RENAME octascope.conf)
install(FILES ${OCTASCOPE_DEPLOY}/octascope.modules-load DESTINATION usr/lib/modules-load.d
        RENAME octascope.conf)

# The machine's configuration: the example with every key commented out, so that it says what there
# is, sets nothing, and what is set in it stands out.
set(machine_configuration ${CMAKE_BINARY_DIR}/package/octascope.toml)
install(CODE "execute_process(COMMAND sed
  -e \"1s/.*/# octascope's configuration: uncomment what this machine needs otherwise./\"
  -e \"s/^[^#]/# &/\" ${OCTASCOPE_DEPLOY}/example.toml
  OUTPUT_FILE ${machine_configuration} COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${machine_configuration} DESTINATION etc/octascope)

# Man pages and completion are made from the program's own --help, so this machine must run it.
set(manual ${CMAKE_BINARY_DIR}/manual)
file(GLOB by_hand CONFIGURE_DEPENDS ${OCTASCOPE_DEPLOY}/man/*.man)
add_custom_command(OUTPUT ${manual}/octascope.1
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual}
  COMMAND ${OCTASCOPE_DEPLOY}/manual $<TARGET_FILE:octascope> ${manual}
  DEPENDS octascope ${OCTASCOPE_DEPLOY}/manual ${OCTASCOPE_DEPLOY}/example.toml ${by_hand}
    ${CMAKE_SOURCE_DIR}/docs/CONFIGURATION.md
  COMMENT "Writing man pages and completion" VERBATIM)
add_custom_target(octascope_manual DEPENDS ${manual}/octascope.1)
install(CODE "
  file(GLOB pages ${manual}/*.[15])
  foreach(page IN LISTS pages)
    get_filename_component(name \${page} NAME)
    string(REGEX MATCH [0-9]$ section \${name})
    set(folder \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/usr/share/man/man\${section})
    file(MAKE_DIRECTORY \${folder})
    execute_process(COMMAND gzip -9nc \${page} OUTPUT_FILE \${folder}/\${name}.gz
                    COMMAND_ERROR_IS_FATAL ANY)
  endforeach()")
install(FILES ${manual}/octascope.bash DESTINATION usr/share/bash-completion/completions
        RENAME octascope)

# What messages and man pages name, and all that these documents link to, placed as they do.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${OCTASCOPE_DOC})
install(CODE "
  set(folder \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${OCTASCOPE_DOC}/deploy)
  file(MAKE_DIRECTORY \${folder})
  file(CREATE_LINK ../example.toml \${folder}/example.toml SYMBOLIC)")

# What lets the service reach a GigE Vision or USB3 Vision camera; nothing of it is in force.
install(DIRECTORY ${OCTASCOPE_DEPLOY}/drop-ins DESTINATION ${OCTASCOPE_DOC})

# NOTICE, and in full the licences of what is compiled into the program itself.
install(FILES README.md ARCHITECTURE.md CONTRIBUTING.md LICENSE NOTICE
              ${OCTASCOPE_DEPLOY}/example.toml ${OCTASCOPE_DEPLOY}/debian/copyright
        DESTINATION ${OCTASCOPE_DOC})
install(CODE "execute_process(COMMAND gzip -9nc ${OCTASCOPE_DEPLOY}/debian/changelog
  OUTPUT_FILE ${CMAKE_BINARY_DIR}/package/changelog.gz COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${OCTASCOPE_DEPLOY}/debian/lintian-overrides DESTINATION usr/share/lintian/overrides
        RENAME octascope)
install(FILES ${CMAKE_BINARY_DIR}/package/changelog.gz DESTINATION ${OCTASCOPE_DOC})
foreach(package libcli11-dev libimgui-dev libglm-dev nlohmann-json3-dev libexpected-dev
                libtomlplusplus-dev fonts-inter)
  install(FILES /usr/share/doc/${package}/copyright DESTINATION ${OCTASCOPE_DOC}/licences
          RENAME ${package})
endforeach()
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/package)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME octascope)
set(CPACK_PACKAGE_CONTACT "The octascope maintainers <octascope@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
    GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Raw spectra from a line-scan camera become optical coherence tomography
volumes while the surgeon works; each is drawn fullscreen on the console and
steered with a foot pedal and a knob. Comes up at boot without a login,
and shows simulated volumes, marked as such, where no camera is plugged in.
.
It is not a medical device.")
# Libraries by dpkg-shlibdeps; beside them what is loaded at run time: Mesa's drivers, libcamera's
# image processing, the seat's manager, udev and systemd themselves.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri, libcamera-ipa, seatd, \
systemd (>= 252), udev, kmod, init-system-helpers (>= 1.54~), passwd")
# For --display window, which an appliance on the console does without.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libsdl2-2.0-0)
# For USB3 Vision and GigE Vision cameras, which few have.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS libaravis-0.8-0)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    ${OCTASCOPE_DEPLOY}/debian/postinst ${OCTASCOPE_DEPLOY}/debian/prerm
    ${OCTASCOPE_DEPLOY}/debian/postrm ${OCTASCOPE_DEPLOY}/debian/conffiles)
include(CPack)
