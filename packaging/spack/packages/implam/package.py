"""Spack recipe of Implam. To use it: spack repo add CLONE/packaging/spack, then spack install implam."""

from spack.package import *


class Implam(CMakePackage):
    """Low-velocity impact on composite laminates: a finite-element program with damage of plies and
    interfaces, for laptops and queues."""

    license("BSD-3-Clause")

    # The source is the clone or unpacked archive that this file lies in: spack develop --path CLONE implam@0.1.0
    version("0.1.0")

    variant("tests", default=False, description="Build the tests")

    depends_on("c", type="build")
    depends_on("fortran", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("ninja", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18:3.22 +mpi +fortran +mumps +metis ~complex ~int64")
    depends_on("mumps +mpi +metis")
    depends_on("metis@5: ~int64")
    depends_on("hdf5 +mpi +fortran")
    depends_on("lapack")

    generator("ninja")

    def cmake_args(self):
        # Spack's own flags say which processor the program is for.
        return [self.define_from_variant("IMPLAM_TESTS", "tests"), self.define("IMPLAM_NATIVE", False)]

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def run_starter(self):
        """The deck that the program writes runs."""
        with working_dir(self.stage.path):
            implam = Executable(self.prefix.bin.implam)
            implam("new", "impact.nml")
            implam("impact.nml")
