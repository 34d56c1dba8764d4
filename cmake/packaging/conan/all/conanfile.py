from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.files import copy, get
from conan.tools.layout import basic_layout
import os

required_conan_version = ">=2.0"


class DuctileConan(ConanFile):
    name = "ductile"
    description = "Plastic joints for rigid-body physics engines: they bend, absorb energy and break the way steel does"
    license = "MIT"
    url = "https://github.com/conan-io/conan-center-index"
    homepage = "https://github.com/ductile/ductile"
    topics = ("physics", "plasticity", "rigid-body", "bullet", "ode", "header-only")

    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    options = {
        "with_bullet3": [True, False],
        "with_ode": [True, False],
    }
    default_options = {
        "with_bullet3": False,
        "with_ode": False,
    }
    no_copy_source = True

    def layout(self):
        basic_layout(self, src_folder="src")

    def requirements(self):
        self.requires("eigen/3.4.0")
        if self.options.with_bullet3:
            self.requires("bullet3/3.25")
        if self.options.with_ode:
            self.requires("ode/0.16.4")

    def package_id(self):
        self.info.clear()

    def validate(self):
        check_min_cppstd(self, 20)

    def source(self):
        get(self, **self.conan_data["sources"][self.version], strip_root=True)

    def build(self):
        pass

    def package(self):
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        for folder in ("include", "adapters/bullet/include", "adapters/ode/include"):
            for pattern in ("*.hpp", "*.ipp"):
                copy(self, pattern, os.path.join(self.source_folder, folder),
                     os.path.join(self.package_folder, "include"))

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "ductile")
        self._component("core", "ductile::ductile", "ductile", ["eigen::eigen"])
        if self.options.with_bullet3:
            double = bool(self.dependencies["bullet3"].options.double_precision)
            name = "bullet_float64" if double else "bullet"
            bullet = self._component(name, f"ductile::{name}", f"ductile-{name.replace('_', '-')}",
                                     ["core", "bullet3::bullet3"])
            bullet.defines = [f"DUCTILE_BULLET_DOUBLE={int(double)}"]
        if self.options.with_ode:
            self._component("ode", "ductile::ode", "ductile-ode", ["core", "ode::ode"])

    def _component(self, name, target, pkg_config, requires):
        component = self.cpp_info.components[name]
        component.set_property("cmake_target_name", target)
        component.set_property("pkg_config_name", pkg_config)
        component.requires = requires
        component.bindirs = []
        component.libdirs = []
        return component
