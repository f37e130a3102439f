#!/usr/bin/env python3
"""test_recipes.py ROOT VERSION: the recipes of Conan and vcpkg fit this project. Prints TAP.

Neither program is needed: a module stands in for Conan, and functions of CMake for vcpkg's, so that the recipes run
up to the point where they would build.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import types

ROOT, VERSION = pathlib.Path(sys.argv[1]), sys.argv[2]
MESON = dict(re.findall(r"^option\('(\w+)', type: '(\w+)'", (ROOT / "meson_options.txt").read_text(), flags=re.M))
LIBRARIES = set(re.findall(r"libraries \+= \{'(\w+)'", (ROOT / "lib/meson.build").read_text()))


class Options(dict):
    get_safe = dict.get
    __getattr__ = dict.get


class Components(dict):
    def __missing__(self, name):
        self[name] = types.SimpleNamespace(requires=[], set_property=lambda *unused: None)
        return self[name]


def load_conan_recipe(made, copied):
    """The recipe's class, with a module that notes what it asks Conan for."""
    class Toolchain:
        def __init__(self, recipe):
            self.project_options = {}
            made.append(self)

        def generate(self):
            pass

    def copy(recipe, pattern, source, target):
        copied[pattern] = list(pathlib.Path(source).glob(pattern))

    contents = {
        "conan": {"ConanFile": object}, "conan.tools": {}, "conan.tools.layout": {"basic_layout": None},
        "conan.tools.files": {"copy": copy, "load": lambda recipe, path: pathlib.Path(path).read_text()},
        "conan.tools.gnu": {"PkgConfigDeps": Toolchain},
        "conan.tools.meson": {"Meson": None, "MesonToolchain": Toolchain}}
    for name, members in contents.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(members)
    space = {}
    exec((ROOT / "packaging/conan/conanfile.py").read_text(), space)  # pylint: disable=exec-used
    return space["SluiceConan"]


def conan_facts():
    made, copied = [], {}
    recipe_class = load_conan_recipe(made, copied)
    for on in (True, False):
        recipe = recipe_class()
        recipe.recipe_folder, recipe.export_sources_folder = str(ROOT / "packaging/conan"), "unused"
        recipe.options = Options({name: on for name in recipe.options})
        required, recipe.settings = [], types.SimpleNamespace(os="Linux")
        recipe.requires = lambda name, required=required, **unused: required.append(name.split("/")[0])
        recipe.cpp_info = types.SimpleNamespace(components=Components())
        recipe.set_version()
        recipe.export_sources()
        recipe.requirements()
        recipe.generate()
        recipe.package_info()
        options = {name: value for name, value in made[-2].project_options.items() if name != "wrap_mode"}
        word = "all_parts" if on else "no_part"
        yield set(options) == set(MESON) and set(options.values()) <= {"enabled", "disabled", False}, \
            f"conan_sets_every_meson_option_with_{word}"
        components = recipe.cpp_info.components
        expected = LIBRARIES - {"bake"} if on else {"open"}
        linked = {need for part in components.values() for need in part.requires}
        yield set(components) == expected | {"core"} and len(required) == len(set(required)) and \
            {need.split("::")[0] for need in linked if "::" in need} == set(required) and \
            {need for need in linked if "::" not in need} <= set(components), f"conan_names_every_library_with_{word}"
    yield recipe.version == VERSION and all(copied.values()), "conan_has_the_version_and_every_source"


STUBS = """
cmake_minimum_required(VERSION 3.21)
set(CURRENT_PORT_DIR "@ROOT@/packaging/vcpkg/ports/sluice")
set(CURRENT_PACKAGES_DIR "@FOLDER@/packages")
set(FEATURES "@FEATURES@")
function(vcpkg_configure_meson)
    cmake_parse_arguments(PARSE_ARGV 0 meson "" "SOURCE_PATH" "OPTIONS;ADDITIONAL_BINARIES")
    message(STATUS "${meson_SOURCE_PATH}: ${meson_OPTIONS}")
endfunction()
function(vcpkg_install_copyright)
    if(NOT EXISTS "${ARGV1}")
        message(FATAL_ERROR "no ${ARGV1}")
    endif()
endfunction()
foreach(name IN ITEMS vcpkg_install_meson vcpkg_fixup_pkgconfig vcpkg_copy_tools)
    cmake_language(EVAL CODE "function(${name})\\nendfunction()")
endforeach()
include("${CURRENT_PORT_DIR}/portfile.cmake")
"""


def vcpkg_facts():
    port = json.loads((ROOT / "packaging/vcpkg/ports/sluice/vcpkg.json").read_text())
    features = set(port["features"])
    yield port["version"] == VERSION and set(port["default-features"]) == features == \
        LIBRARIES - {"bake", "open"}, "vcpkg_has_the_version_and_a_feature_per_library"
    for chosen in (features, {"store"}, set()):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "stubs.cmake"
            text = STUBS.replace("@ROOT@", str(ROOT)).replace("@FOLDER@", folder)
            script.write_text(text.replace("@FEATURES@", ";".join(sorted(chosen))))
            run = subprocess.run(["cmake", "-P", script], capture_output=True, text=True, check=False)
        options = dict(re.findall(r"-D(\w+)=(\w+)", run.stdout))
        on = {name for name, value in options.items() if value == "enabled"} - {"zstd"}
        yield run.returncode == 0 and set(options) == set(MESON) and on == chosen and f"{ROOT}: " in run.stdout, \
            f"vcpkg_sets_every_meson_option_with_{len(chosen)}_features"


number = status = 0
for good, fact in [*conan_facts(), *(vcpkg_facts() if shutil.which("cmake") else [])]:
    number += 1
    status |= not good
    print("ok" if good else "not ok", number, "-", fact)
print(f"1..{number}")
sys.exit(status)
