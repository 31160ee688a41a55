"""Spack recipe of Implam, for Spack 1.0 and later. From a clone or an unpacked source archive, CLONE:

spack repo add CLONE/packaging/spack/spack_repo/implam
spack install implam dev_path=CLONE
"""

from spack_repo.builtin.build_systems.cmake import CMakePackage, generator

from spack.package import *


class Implam(CMakePackage):
    """Low-velocity impact on composite laminates: a finite-element program with damage of plies and
    interfaces, for laptops and queues."""

    license("BSD-3-Clause")

    # No archive is published: the source is the folder given as dev_path.
    version("0.2.0")

    variant("tests", default=False, description="Build the tests")

    generator("ninja")

    depends_on("c", type="build")
    depends_on("fortran", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3.11:", type="build", when="+tests")
    depends_on("mpi")
    depends_on("petsc@3.18:3.22 +mpi +fortran +double +mumps +suite-sparse ~complex ~int64")
    depends_on("metis@5: ~int64 ~real64")
    depends_on("hdf5@1.10: +mpi +fortran")
    depends_on("lapack")

    def cmake_args(self):
        # Spack's compiler wrappers choose the processor.
        return [self.define_from_variant("IMPLAM_TESTS", "tests"), self.define("IMPLAM_NATIVE", False)]

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def run_starter(self):
        """The deck that the program writes runs."""
        with working_dir(join_path(self.build_directory, "starter_run"), create=True):
            implam = Executable(self.prefix.bin.implam)
            implam("new", "impact.nml")
            implam("impact.nml")
