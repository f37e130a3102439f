# An overlay port of a checkout or of an unpacked tarball: vcpkg install sluice --overlay-ports=packaging/vcpkg/ports
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../../../.." ABSOLUTE)

# libvips, which the baker needs, is no package of vcpkg; samples and the viewer are no part of a package.
set(options -Dtests=false -Dbake=disabled -Dastc=disabled -Dsamples=disabled -Dviewer=disabled)
foreach(feature IN ITEMS container exr http neural pbrt store vulkan)
    if(feature IN_LIST FEATURES)
        list(APPEND options -D${feature}=enabled)
    else()
        list(APPEND options -D${feature}=disabled)
    endif()
endforeach()
if("container" IN_LIST FEATURES)
    list(APPEND options -Dzstd=enabled)
else()
    list(APPEND options -Dzstd=disabled)
endif()

vcpkg_configure_meson(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${options}
    ADDITIONAL_BINARIES "glslangValidator = ['${CURRENT_HOST_INSTALLED_DIR}/tools/glslang/glslangValidator']")
vcpkg_install_meson()
vcpkg_fixup_pkgconfig()
vcpkg_copy_tools(TOOL_NAMES sluice-info sluice-replay sluice-tradeoff AUTO_CLEAN)

# sluice-config.cmake finds the libraries from its own place beside them.
set(VCPKG_POLICY_SKIP_MISPLACED_CMAKE_FILES_CHECK enabled)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
