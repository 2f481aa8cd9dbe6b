# Every library that is not ours. The Debian packages that bring them are in deploy/packages.txt and
# packages-test.txt.

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(tl-expected REQUIRED)
find_package(fmt REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(GTest) # of the tests alone, which are left out without it
pkg_check_modules(fftw3f REQUIRED IMPORTED_TARGET fftw3f)
pkg_check_modules(fftw3 REQUIRED IMPORTED_TARGET fftw3)
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(pugixml REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)

if(OCTASCOPE_DISPLAY)
  find_package(glm REQUIRED)
  find_package(nlohmann_json REQUIRED)
  pkg_check_modules(cli11 REQUIRED IMPORTED_TARGET CLI11)
  pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
  pkg_check_modules(evdev REQUIRED IMPORTED_TARGET libevdev)
  pkg_check_modules(freetype REQUIRED IMPORTED_TARGET freetype2)
  pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)
  pkg_check_modules(glesv2 REQUIRED IMPORTED_TARGET glesv2)
  pkg_check_modules(gpiod REQUIRED IMPORTED_TARGET libgpiod)
  pkg_check_modules(hidapi REQUIRED IMPORTED_TARGET hidapi-hidraw)
  pkg_check_modules(sdl2 REQUIRED IMPORTED_TARGET sdl2) # linked by tests; loaded by the program
  add_library(octascope_sdl2_headers INTERFACE)
  target_include_directories(octascope_sdl2_headers SYSTEM INTERFACE ${sdl2_INCLUDE_DIRS})
  pkg_check_modules(aravis IMPORTED_TARGET aravis-0.8>=0.8.20) # linked by tests; loaded by the program
  if(aravis_FOUND)
    add_library(octascope_aravis_headers INTERFACE)
    target_include_directories(octascope_aravis_headers SYSTEM INTERFACE ${aravis_INCLUDE_DIRS})
  else()
    message(STATUS "Aravis not found: GenICam cameras are left out (libaravis-dev, libusb-1.0-0-dev)")
  endif()
  pkg_check_modules(udev REQUIRED IMPORTED_TARGET libudev)
  pkg_check_modules(drm REQUIRED IMPORTED_TARGET libdrm)
  pkg_check_modules(gbm REQUIRED IMPORTED_TARGET gbm)
  pkg_check_modules(libseat REQUIRED IMPORTED_TARGET libseat)
  pkg_check_modules(systemd REQUIRED IMPORTED_TARGET libsystemd)
  pkg_check_modules(libcamera REQUIRED IMPORTED_TARGET libcamera)
  pkg_check_modules(turbojpeg REQUIRED IMPORTED_TARGET libturbojpeg)
  # Its shared library has a driver for files on the network, and brings curl, TLS, LDAP and Kerberos
  # along, which the program that a surgeon looks at shall not have in its memory. Of the archive only
  # what is used is linked. HDF5 1.14 refers to that driver by one function: ours takes its place, and
  # is looked for first.
  pkg_check_modules(hdf5 REQUIRED hdf5)
  find_library(OCTASCOPE_HDF5_ARCHIVE NAMES libhdf5_serial.a libhdf5.a HINTS ${hdf5_LIBRARY_DIRS} REQUIRED)
  find_library(OCTASCOPE_SZ sz REQUIRED)
  add_library(octascope_hdf5 STATIC ${CMAKE_SOURCE_DIR}/cmake/hdf5_without_network.cpp)
  target_include_directories(octascope_hdf5 SYSTEM PUBLIC ${hdf5_INCLUDE_DIRS})
  target_link_options(octascope_hdf5 INTERFACE LINKER:--undefined=H5FD_ros3_init)
  # A target, so that zlib stands behind it on the link line whoever else needs zlib, too.
  add_library(octascope_hdf5_archive STATIC IMPORTED)
  set_target_properties(octascope_hdf5_archive PROPERTIES IMPORTED_LOCATION ${OCTASCOPE_HDF5_ARCHIVE})
  target_link_libraries(octascope_hdf5_archive INTERFACE
    ${OCTASCOPE_SZ} ZLIB::ZLIB ${CMAKE_DL_LIBS} m)
  target_link_libraries(octascope_hdf5 PUBLIC octascope_hdf5_archive)
  # DCMTK's own lists of its libraries bring networks, sound and XML along; a file needs three.
  add_library(octascope_dcmtk INTERFACE)
  foreach(library dcmdata oflog ofstd)
    find_library(OCTASCOPE_${library} ${library} REQUIRED)
    target_link_libraries(octascope_dcmtk INTERFACE ${OCTASCOPE_${library}})
  endforeach()
endif()

# Beside the system's libgpiod 1.x the other API, for the bench of virtual hardware, which asks for it.
set(OCTASCOPE_LIBGPIOD2 "" CACHE PATH
    "Folder of libgpiod 2.x, as tests/virtual_hardware/gpio/libgpiod2 makes it")
if(OCTASCOPE_LIBGPIOD2 AND EXISTS "${OCTASCOPE_LIBGPIOD2}/libgpiod.a")
  add_library(octascope_libgpiod2 STATIC IMPORTED)
  set_target_properties(octascope_libgpiod2 PROPERTIES
    IMPORTED_LOCATION "${OCTASCOPE_LIBGPIOD2}/libgpiod.a"
    INTERFACE_INCLUDE_DIRECTORIES "${OCTASCOPE_LIBGPIOD2}")
endif()

# A parser of 15 k lines in headers: compiled once, in toml_library.cpp, instead of in every file.
add_library(octascope_toml STATIC ${CMAKE_SOURCE_DIR}/cmake/toml_library.cpp)
target_link_libraries(octascope_toml PUBLIC PkgConfig::tomlplusplus)
target_compile_definitions(octascope_toml PUBLIC TOML_HEADER_ONLY=0 TOML_EXCEPTIONS=0)
if(OCTASCOPE_SANITIZE)
  target_compile_options(octascope_toml PRIVATE -fsanitize=${OCTASCOPE_SANITIZE} -O1)
endif()
