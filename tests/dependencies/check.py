"""What sources include is what CMake files declare: packages and libraries, neither fewer nor more; what the Python package imports is
there. Reads files only.

A file belongs to a target folder: the sources of a package (declared in its cmake/Dependencies.cmake), or a folder with a
CMakeLists.txt that links them: tests of a package, programs, whole-program tests. Run by ctest.
"""

import ast
import collections
import os
import pathlib
import re
import sys

SOURCE = pathlib.Path(os.environ["COPLANE_SOURCE"])
sys.path.insert(0, str(SOURCE / "packages/cmake"))
from declared import declared, packages_bottom_to_top, without_comments

# Headers of libraries, and the targets that bring them.
LIBRARIES = [
    (r"Kokkos_\w+\.hpp", ["coplane::kokkos"]),
    (r"Tpetra_\w+\.hpp", ["coplane::tpetra"]),
    (r"Zoltan2_\w+\.hpp", ["coplane::zoltan2"]),
    (r"Teuchos_\w+\.hpp", ["coplane::tpetra", "coplane::zoltan2"]),
    (r"(exodusII|netcdf)\.h", ["coplane::seacas_exodus"]),
    (r"hdf5\.h", ["coplane::hdf5"]),
    (r"mpi\.h", ["MPI::MPI_CXX"]),
    (r"fmt/.*", ["fmt::fmt"]),
    (r"spdlog/.*", ["spdlog::spdlog"]),
    (r"yaml-cpp/.*", ["yaml-cpp::yaml-cpp"]),
    (r"nlohmann/.*", ["nlohmann_json::nlohmann_json"]),
    (r"muParser\.h", ["muparser::muparser"]),
    (r"openssl/.*", ["OpenSSL::Crypto"]),
    (r"CLI/.*", ["CLI11::CLI11"]),
    (r"(gmsh\.h|assimp/.*|voro\+\+/.*)", ["coplane::gmsh"]),
    (r"gtest/.*", ["GTest::gtest"]),
    (r"benchmark/.*", ["benchmark::benchmark"]),
]
# The standard library of C++, and the system: no target.
SYSTEM = r"[a-z_0-9]+|experimental/simd|sys/\w+\.h|(dlfcn|execinfo|fcntl|malloc|poll|sched|spawn|unistd)\.h"
PACKAGES = packages_bottom_to_top()
# Headers of programs and of tests, which others find by an include folder.
LOCAL = {path.name for top in ("apps/*/src", "packages/*/test", "packages/core/testing") for path in SOURCE.glob(f"{top}/*.hpp")}


def includes(path):
    """Line, name and whether it is in quotes, of every #include."""
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
        if found:
            yield number, found.group(2), found.group(1) == '"'


def sources(folder):
    """C++ files in a folder, without those of folders below it that have a CMakeLists.txt of their own."""
    apart = [path.parent for path in folder.rglob("CMakeLists.txt") if path.parent != folder]
    return [path for path in sorted(folder.rglob("*")) if re.search(r"\.(cpp|hpp)(\.in)?$", path.name)
            and not any(other in path.parents for other in apart)]  # fmt: skip


def linked(folder, passed_on=False):
    """Targets that a CMakeLists.txt links, by coplane_unit_test and target_link_libraries; those that it passes on, or all."""
    text = without_comments((folder / "CMakeLists.txt").read_text())
    targets = set()
    for name, call in re.findall(r"(coplane_unit_test|target_link_libraries)\s*\(([^)]*)\)", text):
        targets |= {"coplane::testing"} if name == "coplane_unit_test" and not passed_on else set()
        targets.update(re.findall(r"[\w-]+::[\w-]+", call.split("PRIVATE")[0] if passed_on else call))
    return targets


def targets_of(name):
    """Those that bring a header; empty: the system, or a header of programs and tests; None: not known."""
    package = re.match(r"coplane_(\w+)/", name)
    if package:
        return [f"coplane::{package.group(1)}"]
    for pattern, targets in LIBRARIES:
        if re.fullmatch(pattern, name):
            return targets
    return [] if re.fullmatch(SYSTEM, name) or name in LOCAL else None


def check_folder(wrong, where, files, declared_here, inherited):
    """Every include has its target among those declared here or inherited, and every target declared here its include."""
    used = collections.Counter()
    for path in files:
        for line, name, quoted in includes(path):
            if quoted:
                continue
            place = f"{path.relative_to(SOURCE)}:{line}: <{name}>"
            targets = targets_of(name)
            if targets is None:
                wrong.append(f"{place}: of no library known to {pathlib.Path(__file__).relative_to(SOURCE)}")
            elif targets and not any(target in declared_here | inherited for target in targets):
                wrong.append(f"{place}: {where} does not declare {' or '.join(targets)}")
            else:
                used.update(targets)
    wrong += [f"{where} declares {target}, but no source includes it" for target in sorted(declared_here) if not used[target]]
    wrong += [f"{where} declares {target} again" for target in sorted(declared_here & inherited)]


def public_headers():
    """Headers of packages that a file outside their package includes, directly or by way of another header."""
    found, todo = set(), []
    for folder in ("packages", "apps", "tests"):
        for path in (SOURCE / folder).rglob("*.[ch]pp"):
            own = path.relative_to(SOURCE).parts[1] if folder == "packages" else ""
            todo += [name for _, name, _ in includes(path) if name.startswith("coplane_") and not name.startswith(f"coplane_{own}/")]
    while todo:
        path = header(todo.pop())
        if path not in found and path.is_file():
            found.add(path)
            todo += [f"{path.parent.relative_to(source_of(path))}/{name}" if quoted else name
                     for _, name, quoted in includes(path) if quoted or name.startswith("coplane_")]  # fmt: skip
    return found


def source_of(path):
    """packages/<name>/src, of a file in it."""
    return SOURCE.joinpath(*path.relative_to(SOURCE).parts[:3])


def header(name):
    return SOURCE / "packages" / re.match(r"coplane_(\w+)/", name).group(1) / "src" / name


def check_package(wrong, package, public):
    folder = SOURCE / "packages" / package
    lists = declared(package)
    where = f"packages/{package}/cmake/Dependencies.cmake"
    for other in lists["PACKAGES"]:
        if other not in PACKAGES[: PACKAGES.index(package)]:
            wrong.append(f"{where}: {other} is not earlier in packages/PackagesList.cmake")
    targets = {f"coplane::{other}" for other in lists["PACKAGES"]} | set(lists["LIBRARIES"]) | set(lists["PRIVATE_LIBRARIES"])
    files = sources(folder / "src")
    check_folder(wrong, where, files, targets, {f"coplane::{package}"})

    # A library is public when a header that others see includes it.
    seen = {target for path in files if path in public for _, name, _ in includes(path) for target in targets_of(name) or []}
    wrong += [f"{where}: {library} is of PRIVATE_LIBRARIES: no header that others include needs it" for library in lists["LIBRARIES"] if library not in seen]
    wrong += [f"{where}: {library} is of LIBRARIES: a header that others include needs it" for library in lists["PRIVATE_LIBRARIES"] if library in seen]
    return targets - set(lists["PRIVATE_LIBRARIES"]) | {f"coplane::{package}"}


def check_details(wrong):
    """Headers in a folder detail/ are of their package only; others do not include them, nor do headers outside detail/."""
    for folder in ("packages", "apps", "tests"):
        for path in (SOURCE / folder).rglob("*.[ch]pp"):
            parts = path.relative_to(SOURCE).parts
            for line, name, _ in includes(path):
                if "detail/" not in name:
                    continue
                place = f"{path.relative_to(SOURCE)}:{line}: {name}"
                if name.startswith("coplane_") and (folder != "packages" or not name.startswith(f"coplane_{parts[1]}/")):
                    wrong.append(f"{place}: is private to its package")
                elif path.suffix == ".hpp" and parts[2] == "src" and "detail" not in parts:
                    wrong.append(f"{place}: is not installed, but this header is")


def check_python(wrong):
    """Modules of the Python package import the standard library, what everything needs, and each other; the rest goes through needs(),
    which knows its Debian package."""
    always = {"numpy", "netCDF4", "yaml"}
    folder = SOURCE / "packages/python/coplane"
    known = ast.parse((folder / "needs.py").read_text())
    optional = {key.value for node in ast.walk(known) if isinstance(node, ast.Dict) for key in node.keys}
    for path in sorted(folder.glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) and node.level == 0 else []
            where = f"{path.relative_to(SOURCE)}:{getattr(node, 'lineno', 0)}"
            wrong += [f"{where}: imports {name}: use needs(), or ask for it in pyproject.toml and always" for name in names
                      if name.split(".")[0] not in always | sys.stdlib_module_names]  # fmt: skip
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "needs" and not {node.args[0].value, node.args[0].value.split(".")[0]} & optional:
                wrong.append(f"{where}: needs.py does not know {node.args[0].value}")


def main():
    wrong = []
    public = public_headers()
    passed_on = {package: check_package(wrong, package, public) for package in PACKAGES}
    testing = linked(SOURCE / "packages/core/testing", passed_on=True)

    folders = {path.parent for top in ("packages/*/*", "apps/*", "apps/*/*", "tests/*", "tests/*/*") for path in SOURCE.glob(f"{top}/CMakeLists.txt")}
    for folder in sorted(folders):
        where = f"{folder.relative_to(SOURCE)}/CMakeLists.txt"
        targets, inherited = linked(folder), set()
        if folder.name == "test":
            package = folder.parent.name if folder.parent.parent.name == "packages" else None
            inherited |= passed_on[package] if package else linked(folder.parent, passed_on=True)
            targets.discard(f"coplane::{package}")
        if "coplane::testing" in targets:
            targets.discard("coplane::testing")
            inherited |= testing
        check_folder(wrong, where, sources(folder), targets, inherited)
    check_details(wrong)
    check_python(wrong)
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(PACKAGES)} packages and {len(folders)} folders of programs and tests declare what they include")


if __name__ == "__main__":
    main()
