"""Conan 2: conan create packaging/conan, in a checkout or beside an unpacked tarball."""
import os
import re

from conan import ConanFile
from conan.tools.files import copy, load
from conan.tools.gnu import PkgConfigDeps
from conan.tools.layout import basic_layout
from conan.tools.meson import Meson, MesonToolchain

# Each option is a feature of meson_options.txt, and the packages of Conan Center that it needs.
PARTS = {
    "exr": ["openexr/3.2.4"],
    "store": ["zstd/1.5.6", "xxhash/0.8.2"],
    "container": [],
    "zstd": ["zstd/1.5.6"],
    "pbrt": ["zlib/1.3.1"],
    "neural": ["zlib/1.3.1"],
    "http": ["libcurl/8.9.1", "xxhash/0.8.2"],
    "vulkan": ["vulkan-headers/1.3.290.0"],
}
# libvips, which the baker needs, is not in Conan Center; samples and the viewer are no part of a package.
LEFT_OUT = ["bake", "astc", "samples", "viewer"]
# In the order in which they use one another; "" is the core.
LIBRARIES = ["", "exr", "store", "container", "neural", "http", "open", "pbrt", "vulkan"]


class SluiceConan(ConanFile):
    name = "sluice"
    license = "MIT"
    description = "Keeps in GPU memory only the tiles of textures that shaders sample"
    topics = ("vulkan", "texture-streaming", "virtual-texturing", "sampler-feedback")
    settings = "os", "arch", "compiler", "build_type"
    package_type = "library"
    options = {"shared": [True, False], **{part: [True, False] for part in PARTS}}
    default_options = {"shared": False, **{part: True for part in PARTS}}

    @property
    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        self.version = re.search(r"^  version: '(.*)',$", load(self, os.path.join(self._root, "meson.build")), re.M)[1]

    def export_sources(self):
        for name in ("meson.build", "meson_options.txt", "LICENSE", "include/*", "lib/*", "shaders/*", "tools/*",
                     "samples/*", "scripts/dev/*", "tests/device/*", "tests/support/*", "docs/reference/*"):
            copy(self, name, self._root, self.export_sources_folder)

    def configure(self):
        self.settings.rm_safe("compiler.cppstd")
        self.settings.rm_safe("compiler.libcxx")

    def requirements(self):
        wanted = {package for part, packages in PARTS.items() if self.options.get_safe(part) for package in packages}
        for package in sorted(wanted):
            self.requires(package, transitive_headers=package.startswith("vulkan"))

    def build_requirements(self):
        self.tool_requires("meson/[>=1.0]")
        if self.options.vulkan:
            self.tool_requires("glslang/1.3.290.0")

    def layout(self):
        basic_layout(self)

    def generate(self):
        toolchain = MesonToolchain(self)
        for part in PARTS:
            toolchain.project_options[part] = "enabled" if self.options.get_safe(part) else "disabled"
        for part in LEFT_OUT:
            toolchain.project_options[part] = "disabled"
        toolchain.project_options["tests"] = False
        toolchain.project_options["wrap_mode"] = "nofallback"
        toolchain.generate()
        PkgConfigDeps(self).generate()

    def build(self):
        meson = Meson(self)
        meson.configure()
        meson.build()

    def package(self):
        Meson(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        made = [name for name in LIBRARIES if name in ("", "open") or self.options.get_safe(name)]
        for name in made:
            component = self.cpp_info.components[name or "core"]
            component.libs = [f"sluice-{name}" if name else "sluice"]
            component.set_property("pkg_config_name", component.libs[0])
            component.set_property("cmake_target_name", f"sluice::{name or 'sluice'}")
            component.requires = [package.split("/")[0] + "::" + package.split("/")[0] for package in PARTS.get(name, [])]
            if name:
                component.requires.append("core")
            if name == "container" and self.options.zstd:
                component.requires.append("zstd::zstd")
            if name == "open":
                component.requires += [other for other in made if other in ("exr", "store", "container", "neural")]
        if self.settings.os != "Windows":
            self.cpp_info.components["core"].system_libs = ["m", "pthread"]
