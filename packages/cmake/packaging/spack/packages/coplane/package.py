# Spack 0.23 or newer: from the source tree,
#   spack repo add packages/cmake/packaging/spack
#   spack dev-build coplane@0.1.0
# docs/user/installing.md says what of this was tried.
from spack.package import *


class Coplane(CMakePackage):
    """Explicit Lagrangian finite elements with Simple Common Plane contact: jointed rock, masonry, things that break and collide."""

    license("BSD-3-Clause")
    version("0.1.0")

    variant("processor", default="native", description="what to compile for, as for -march=")
    variant("tools", default=True, description="Python modules of reports, tables, plots, vector graphics and `coplane new`")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("mpi")
    # The parts that are needed, and none of those that Spack's recipe switches on by itself: aztec conflicts with ~fortran, the others on
    # Epetra with ~epetra, and each of them takes minutes to compile.
    depends_on(
        "trilinos@13.2.0 +mpi+openmp+shared+kokkos+tpetra+zoltan+zoltan2+exodus+explicit_template_instantiation"
        "~fortran~complex~float~amesos~amesos2~anasazi~aztec~belos~epetra~epetraext~ifpack~ifpack2~ml~muelu~sacado"
        " gotype=long_long cxxstd=17"
    )
    depends_on("hdf5+mpi")
    depends_on("netcdf-c@:4.8+mpi+parallel-netcdf")  # 4.9 has a macro of the name of a constant in Trilinos 13.2 (dependencies.sh)
    depends_on("parallel-netcdf")
    depends_on("cli11")
    depends_on("fmt")
    depends_on("spdlog")
    depends_on("yaml-cpp")
    depends_on("nlohmann-json")
    depends_on("openssl")
    depends_on("muparser")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-netcdf4", type="run")
    depends_on("py-pyyaml", type="run")
    with when("+tools"):
        for _name in ("plotly", "pandas", "xarray", "jsonschema", "ruamel-yaml", "matplotlib", "pillow"):
            depends_on(f"py-{_name}", type="run")

    requires("%gcc@11:", msg="std::experimental::simd of GCC's standard library")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define_from_variant("COPLANE_ARCH", "processor"),
            self.define("COPLANE_TESTS", False),
            self.define("COPLANE_BENCHMARKS", False),
            self.define("COPLANE_TRILINOS", self.spec["trilinos"].prefix),
        ]

    @run_after("install")
    def use_python_of_spack(self):
        scripts = [join_path(self.prefix.bin, f"coplane_{word}") for word in ("new", "pictures", "report", "watch")]
        scripts += [join_path(self.prefix, "share/coplane/exodus_inputs/run.py")]
        filter_file(r"^#!/usr/bin/python3$", "#!" + self.spec["python"].command.path, *scripts)

    def setup_run_environment(self, env):
        env.prepend_path("PYTHONPATH", self.prefix.share.coplane.python)
