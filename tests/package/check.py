"""The Debian packages. Argument: launcher, recipes, main_job, this_build (these with what is built), or every_processor (builds
packages/cmake/packaging/make-packages.sh, and installs with apt in a system that debootstrap makes). Packages are installed in a root folder of
their own, and used by somebody without a home who can read neither the sources nor the build nor its Trilinos. Needs root; ends with 77 where
that cannot be."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

SOURCE, BINARIES = (pathlib.Path(os.environ[name]) for name in ("COPLANE_SOURCE", "COPLANE_BIN"))
BUILD = BINARIES.parent
TRILINOS = pathlib.Path(re.search(r"^COPLANE_TRILINOS:\w+=(.*)", (BUILD / "CMakeCache.txt").read_text(), flags=re.M).group(1)).resolve()
LEVELS = ["x86-64-v4", "x86-64-v3", "x86-64-v2", "x86-64"]
SKIPPED = 77
ROOT = pathlib.Path("clean/root").absolute()
UPPER = ROOT.parent / "upper"
# Names that shells and scripts stumble over.
FOLDER = "/tmp/my runs (1) \u00e9"
# The main job has no coarse size: its 6524 elements are the coarsest mesh of the wall. To 0.3 ms it takes seconds, the bar has struck (its gap of
# 5 mm is closed after 0.09 ms), and bricks have joints, slip and damage. All 41 ms, two minutes, are the test paper.bar_wall_3d.S; that the
# package computes the same is what the state hash says.
MAIN_JOB = ["bar_wall_3d", "--size", "S", "--no-pictures", "--no-check", "--set", "time.end=3e-4"]


def run(command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    assert done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stdout[-4000:]}"
    return done.stdout


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


BEGAN = time.monotonic()


def passed(what):
    print(f"passed [{time.monotonic() - BEGAN:4.0f} s]: {what}", flush=True)


def state_hash(log):
    return re.search(r"state hash (\w+)", log).group(1)


def state_of_build():
    """At the end of the main job as the programs of the build compute it."""
    folder = pathlib.Path("same").absolute()
    shutil.rmtree(folder, ignore_errors=True)
    return state_hash(run([sys.executable, SOURCE / "exodus_inputs/run.py", *MAIN_JOB, "--output", folder]))


# The launcher.


def check_launcher():
    """The best level that the processor has and that is installed, with the arguments; an error where none is."""
    flags = run(["/lib64/ld-linux-x86-64.so.2", "--help"])
    supported = [level for level in LEVELS[:-1] if re.search(rf"^ *{level} \(supported", flags, flags=re.M)] + ["x86-64"]
    shutil.rmtree("launched", ignore_errors=True)
    program = pathlib.Path("launched/bin/coplane").absolute()
    program.parent.mkdir(parents=True)
    shutil.copy(BINARIES / "coplane_launcher", program)
    folder = program.parents[1] / "lib/coplane/levels"
    for level in LEVELS:
        (folder / level).mkdir(parents=True)
        script = folder / level / "coplane"
        script.write_text(f'#!/bin/sh\necho {level} "$#" "$2"\nexit 8\n')
        script.chmod(0o755)
    for level in supported:
        done = subprocess.run([program, "deck.yaml", "two words"], stdout=subprocess.PIPE, text=True)
        assert (done.returncode, done.stdout) == (8, f"{level} 2 two words\n"), (level, done)
        (folder / level / "coplane").unlink()
    done = subprocess.run([program], stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2 and "coplane for this processor" in done.stderr and str(folder) in done.stderr, done
    passed(f"launcher: {' '.join(supported)}")


# Recipes for Spack and for containers: what can be said about them without either.


def check_recipes():
    """The recipe for Spack is Python, its specs are such, and what it sets is there to be set. Packages, container and Spack bring the same Python modules."""
    recipe = (SOURCE / "packages/cmake/packaging/spack/packages/coplane/package.py").read_text()
    compile(recipe, "package.py", "exec")
    options = "".join(path.read_text() for path in (SOURCE / "packages/cmake").glob("*.cmake"))
    names = re.findall(r"define(?:_from_variant)?\(\"(\w+)\"", recipe)
    assert names and all(re.search(rf"(set|option)\({name} ", options) for name in names), names
    number = re.search(r"Coplane VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
    assert f'version("{number}")' in recipe, f"not of version {number}"
    # A value in a spec ends at a blank only: cxxstd=17~fortran is one value.
    specs = ["".join(re.findall(r'"([^"]*)"', found)) for found in re.findall(r"depends_on\(\s*((?:\"[^\"]*\"\s*)+)", recipe)]
    wrong = [spec for spec in specs if not re.fullmatch(r"[\w-]+(@[\w.:]+)?( ?[+~][\w-]+)*( \w+=[\w.-]+)*", spec)]
    assert len(specs) > 15 and not wrong, wrong
    modules = set(re.findall(r'"([\w.-]+)"', re.search(r"for _name in \((.*?)\)", recipe).group(1)))

    sys.path.insert(0, str(SOURCE / "packages/python"))
    from coplane.needs import DEBIAN

    recommended, suggested = (re.search(rf"RUN_PACKAGE_{kind} \"(.*)\"", options).group(1).split(", ") for kind in ("RECOMMENDS", "SUGGESTS"))
    wanted = {name for name in DEBIAN.values() if not any(name in choice.split(" | ") for choice in suggested)}
    assert wanted == set(recommended), f"what Python imports where it is used, and what the package recommends: {wanted ^ set(recommended)}"
    assert {name.removeprefix("python3-").replace("pil", "pillow").replace(".", "-") for name in recommended} == modules, (recommended, modules)
    container = (SOURCE / "packages/cmake/packaging/container/Containerfile").read_text()
    drawing = (SOURCE / "packages/cmake/debian-packages-paraview.txt").read_text().partition("\n")[2].split()
    missing = {*recommended, *drawing} - set(re.findall(r"[\w.-]+", container))
    assert not missing, f"packages that the container lacks: {missing}"
    lost = {*drawing} - {choice for entry in recommended + suggested for choice in entry.split(" | ")}
    assert not lost, f"packages that draw and that the Debian package neither recommends nor suggests: {lost}"
    passed(f"recipes: {' '.join(names)}, {len(specs)} specs of Spack; {', '.join(recommended)}")


# The set-up command where the package is installed.


def check_main_job():
    """main-job.sh takes the programs on PATH where they are of its very source tree, and builds nothing; else it turns to what building needs."""
    tree, programs, folder = (pathlib.Path(name).absolute() for name in ("tree", "installed", "main-job"))
    for old in (tree, programs, folder):
        shutil.rmtree(old, ignore_errors=True)
    # A tree of its own with what the job needs, so that nothing is changed in it since its only commit.
    for name in ("packages/cmake", "packages/python", "exodus_inputs", "apps/coplane/paraview", "docs/schemas"):
        shutil.copytree(SOURCE / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(SOURCE / "CMakeLists.txt", tree)
    for words in ("init -q", "add -A", "-c user.name=test -c user.email=test@localhost commit -q -m all"):
        run(["git", "-C", tree, *words.split()])
    revision = run(["git", "-C", tree, "describe", "--always"]).strip()
    said = run([BINARIES / "coplane", "--version"])
    number, built = re.match(r"coplane (\S+) \((.*?);", said).groups()
    programs.mkdir()
    (programs / "coplane_mesh").symlink_to(BINARIES / "coplane_mesh")

    def job(of):
        """For 10 microseconds, with programs that say that they are of some version and revision, and no Trilinos to build with."""
        program = programs / "coplane"
        text = said.replace(f"{number} ({built};", f"{of};").strip()
        program.write_text(f'#!/bin/sh\n[ "$1" != --version ] || {{ echo \'{text}\'; exit 0; }}\nexec "{BINARIES}/coplane" "$@"\n')
        program.chmod(0o755)
        environment = {name: value for name, value in os.environ.items() if not name.startswith("COPLANE_")}
        environment.update(PATH=f"{programs}:{os.environ['PATH']}", COPLANE_TRILINOS="/nowhere")
        done = subprocess.run([tree / "packages/cmake/main-job.sh", "--no-pictures", "--folder", folder, "--end", "1e-5"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, env=environment)  # fmt: skip
        return done.returncode, done.stdout

    for of in (f"{number} (0000000", f"9.{number} ({revision}", f"{number} ({revision}-dirty"):
        code, log = job(of)
        assert code and "nothing is built" not in log and "/nowhere" in log, f"{of}: {log}"
    code, log = job(f"{number} ({revision}")
    assert code == 0 and f"programs of this version are installed in {programs}: nothing is built" in log, log
    assert (folder / "run.e").stat().st_size and re.search(rf"running: .* {programs}/coplane run.yaml", log), log
    assert not (tree / "build").exists(), "something was configured"
    with open(tree / "CMakeLists.txt", "a") as file:
        file.write("# changed\n")
    for of in (f"{number} ({revision}", f"{number} ({revision}-dirty"):
        code, log = job(of)
        assert code and "nothing is built" not in log, f"{of}, in a tree that was changed: {log}"
    passed(f"main-job.sh with programs that are installed, {revision}")


# Roots to install in.


def mount_common(root):
    run(["mount", "-t", "proc", "proc", root / "proc"])
    for folder in ("dev", "sys"):
        run(["mount", "--rbind", f"/{folder}", root / folder])
    run(["mount", "-t", "tmpfs", "-o", "mode=1777", "tmpfs", root / "tmp"])


def own_file_system():
    """For ROOT; it goes with this process."""
    ROOT.parent.mkdir(exist_ok=True)
    run(["mount", "-t", "tmpfs", "tmpfs", ROOT.parent])


def overlay():
    """This machine, with all changes elsewhere, and without the sources, the build and its Trilinos."""
    own_file_system()
    for folder in (ROOT, UPPER, ROOT.parent / "work"):
        folder.mkdir()
    layers = f"lowerdir=/,upperdir={UPPER},workdir={ROOT.parent}/work"
    if subprocess.run(["mount", "-t", "overlay", "-o", layers, "overlay", ROOT]).returncode:
        skip("no overlay file systems here")
    mount_common(ROOT)
    for hidden in (SOURCE, BUILD, TRILINOS):
        place = ROOT / hidden.relative_to("/")
        if place.is_dir():
            run(["mount", "-t", "tmpfs", "-o", "mode=700", "tmpfs", place])


def debootstrap():
    """A new Debian 12."""
    if not shutil.which("debootstrap"):
        skip("apt-get install debootstrap")
    own_file_system()
    run(["debootstrap", "--variant=minbase", "bookworm", ROOT])
    mount_common(ROOT)


def in_root(*command):
    return run(["chroot", ROOT, "env", "-C", "/", "DEBIAN_FRONTEND=noninteractive", *command])


def as_user(script):
    """What a shell prints that runs a script as nobody, in FOLDER, without HOME."""
    place = ROOT / FOLDER[1:]
    place.mkdir(exist_ok=True)
    os.chown(place, 65534, 65534)
    return run(["chroot", "--userspec=65534:65534", ROOT, "env", "-i", "-C", FOLDER, "PATH=/usr/bin:/bin", "LANG=C.UTF-8", "bash", "-euc", script])


# What is installed.


def installed_files():
    listed = [line for line in in_root("dpkg", "-L", "coplane").splitlines() if "coplane" in line]
    assert len(listed) > 100, listed
    return [ROOT / name[1:] for name in listed]


def check_files():
    """All can be read by everybody and written by root alone; programs and libraries find each other here."""
    own = [str(path).encode() for path in (SOURCE, BUILD, TRILINOS)]
    programs = 0
    for path in installed_files():
        status = path.lstat()
        if path.is_symlink():
            assert not os.readlink(path).startswith("/"), path
            continue
        wanted = 0o555 if path.is_dir() else 0o444
        assert status.st_mode & wanted == wanted and not status.st_mode & 0o022 and status.st_uid == 0, f"{path}: {status.st_mode:o}"
        if path.is_dir():
            continue
        content = path.read_bytes()
        if content[:4] != b"\x7fELF":
            assert not any(name in content for name in own), f"{path} names a folder of the build"
            continue
        programs += 1
        runpath = re.search(r"R(?:UN)?PATH.*\[(.*)\]", run(["readelf", "-d", path]))
        assert not runpath or re.fullmatch(r"\$ORIGIN(/\.\.)*(/lib/coplane)?/?", runpath.group(1)), f"{path}: {runpath.group(1)}"
        libraries = as_user(f"ldd '/{path.relative_to(ROOT)}'")
        places = [os.path.normpath(place) for place in re.findall(r"=> (/\S+)", libraries)]
        assert "not found" not in libraries and all(place.startswith(("/usr/lib/", "/lib/")) for place in places), f"{path}: {libraries}"
    passed(f"files: {programs} programs and libraries")


def check_use(same_as):
    """The programs, the Python package, the main job, the documents, the manual pages and the completion, as somebody uses them."""
    for name in ("coplane", "coplane_mesh", "coplane_point"):
        said = as_user(f"{name} --version")
        assert re.match(rf"{name} \d", said), said
    where = as_user("python3 -c 'import coplane; print(coplane.program.binary(\"coplane\"), coplane.program.schema(\"deck\").exists())'")
    assert where.split() == ["/usr/bin/coplane", "True"], where
    as_user("coplane_point /usr/share/coplane/exodus_inputs/joint_paths/mortar.yaml")
    quoted = " ".join(f"'{word}'" for word in MAIN_JOB)
    said = as_user(f"/usr/share/coplane/exodus_inputs/run.py {quoted}")
    assert state_hash(said) == same_as, f"state hash {state_hash(said)}, of the build {same_as}"
    as_user("coplane report coplane-examples/bar_wall_3d/S --no-pictures -o report.html && test -s report.html")
    passed(f"main job to 0.3 ms: state hash {same_as}")
    check_first_hour()
    site = ROOT / "usr/share/doc/coplane/html"
    lacking = [name for name in ("index.html", "docs/user/python.html", "docs/keys.html", "search/search_index.json") if not (site / name).exists()]
    assert not lacking, f"the site of the documents lacks {lacking}"
    for name in ("coplane", "coplane_mesh", "coplane_new", "coplane_pictures", "coplane_point", "coplane_report", "coplane_watch"):
        page = as_user(f"man -P cat {name}") if (ROOT / "usr/bin/man").exists() else run(["man", "-P", "cat", ROOT / f"usr/share/man/man1/{name}.1.gz"])
        assert re.search(rf"{name} - \w+", page) and "--help" in page, page
    complete = ". /usr/share/bash-completion/completions/{}; COMP_WORDS=({}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _coplane_programs; echo ${{COMPREPLY[*]}}"
    for words, expected in (("coplane --ba", "--backend"), ("coplane --backend ''", "serial threads"), ("coplane_mesh ma", "make"),
                            ("coplane_mesh make --o", "--output"), ("coplane report --no", "--no-pictures"), ("coplane de", "")):
        found = as_user(complete.format(words.split()[0], words)).strip()
        assert found == expected, f"{words}: {found}"
    passed("manual pages, completion")


def check_first_hour():
    """A problem of one's own, looked at from Python, in the terminal, as vector graphics and, where ParaView is, as pictures."""
    as_user("coplane new mine/wall --like bars_2d && mkdir out && cd out && coplane ../mine/wall/wall.yaml --set time.end=3e-4 >wall.log 2>&1")
    # The lines at the top of docs/user/python.md as they stand there.
    example = re.search(r"```python\n(.*?)```", (ROOT / "usr/share/coplane/docs/user/python.md").read_text(), flags=re.S).group(1)
    drawn = "import matplotlib.pyplot as plt; print([line.get_label() for line in plt.gca().lines], len(plt.gca().lines[0].get_xdata()) > 10)"
    said = as_user(f"MPLBACKEND=agg python3 -c '{example}{drawn}'")
    assert said.splitlines()[-1] == "['kinetic', 'internal'] True", said
    said = as_user("coplane watch out/wall")
    assert "completed, exit code 0" in said, said
    as_user("coplane pictures out/wall --vector wall.svg && grep -q '<svg' wall.svg")
    looked = "plot, watch, vector graphics"
    if all((ROOT / f"usr/bin/{name}").exists() for name in ("pvbatch", "xvfb-run", "xauth")):
        as_user("coplane pictures out/wall --strip 2 --size 300 200")
        width, height = as_user("python3 -c 'import PIL.Image; print(*PIL.Image.open(\"out/pictures/wall_strip.png\").size)'").split()
        assert int(width) >= 600 and height == "200", (width, height)  # the legend stands beside the bodies
        looked += ", ParaView"
    passed(f"a problem of one's own: {looked}")


def check_purged():
    """Nothing is left of the package."""
    in_root("dpkg", "--purge", "coplane")
    left = [str(path.relative_to(UPPER)) for path in UPPER.rglob("*") if path.is_symlink() or not path.is_dir() or "coplane" in path.name]
    left = [name for name in left if not re.match(r"(var/(lib/dpkg|log|cache)|tmp|run)/|etc/ld.so.cache", name)]
    assert not left, left
    passed("purged: nothing is left")


def install_old():
    """A package of an earlier version, with a file that the new one has not."""
    old = pathlib.Path("old")
    shutil.rmtree(old, ignore_errors=True)
    (old / "DEBIAN").mkdir(parents=True)
    (old / "DEBIAN/control").write_text("Package: coplane\nVersion: 0.0.9-1\nArchitecture: amd64\nMaintainer: Coplane <coplane@localhost>\nDescription: old\n")
    for name in ("bin/coplane", "share/coplane/of-old"):
        (old / "usr" / name).parent.mkdir(parents=True, exist_ok=True)
        (old / "usr" / name).write_text("old\n")
    run(["dpkg-deb", "--root-owner-group", "-Znone", "-b", old, ROOT / "tmp/old.deb"])
    in_root("dpkg", "-i", "/tmp/old.deb")


def package_of_this_build():
    folder = pathlib.Path("packages").absolute()
    shutil.rmtree(folder, ignore_errors=True)
    # One of the two packages, not compressed, for speed; by somebody who shows nothing to others.
    run(["cpack", "-G", "DEB", "-B", folder, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none", "-D", "CPACK_COMPONENTS_ALL=programs;common"], cwd=BUILD, umask=0o077)
    package, = folder.glob("*.deb")
    passed(f"packed: {package.name}, {package.stat().st_size / 1e6:.0f} MB not compressed")
    return package


def check_this_build():
    package = package_of_this_build()
    same_as = state_of_build()
    overlay()
    install_old()
    shutil.copy(package, ROOT / "tmp/coplane.deb")
    in_root("dpkg", "-i", "/tmp/coplane.deb")
    assert not (ROOT / "usr/share/coplane/of-old").exists(), "a file of the version before is left"
    check_files()
    check_use(same_as)
    check_purged()


def check_every_processor():
    folder = pathlib.Path("packages").absolute()
    print(run([SOURCE / "packages/cmake/packaging/make-packages.sh", folder]))
    same_as = state_of_build()
    debootstrap()
    for package in folder.glob("*.deb"):
        shutil.copy(package, ROOT / "tmp")
    in_root("sh", "-c", "apt-get update -qq && apt-get install -y -qq /tmp/coplane_*.deb")
    passed("installed with apt, and what it recommends")
    in_root("sh", "-c", "apt-get install -y -qq paraview python3-paraview xvfb xauth")
    passed("ParaView installed")
    check_files()
    check_use(same_as)
    check_levels(same_as)
    in_root("sh", "-c", "apt-get install -y -qq --no-install-recommends /tmp/coplane-dev_*.deb")
    shutil.copytree(SOURCE / "tests/package/user", ROOT / "tmp/user")
    said = as_user("cmake -S /tmp/user -B build >log 2>&1 && cmake --build build >>log 2>&1 || { cat log; exit 1; }; build/user")
    assert said.split()[1:] == ["6"], said
    passed("a program of somebody else, with coplane-dev")
    in_root("apt-get", "purge", "-y", "-qq", "coplane", "coplane-dev")
    left = run(["find", ROOT / "usr", ROOT / "etc", "-name", "*coplane*"])
    assert not left, left
    passed("purged: nothing is left")


def check_levels(same_as):
    """Every level that this processor has ends in the same state."""
    folder = ROOT / "usr/lib/coplane/levels"
    flags = run(["/lib64/ld-linux-x86-64.so.2", "--help"])
    levels = [path.name for path in folder.iterdir() if path.name == "x86-64" or re.search(rf"^ *{path.name} \(supported", flags, flags=re.M)]
    assert len(levels) > 1, levels
    for level in levels:
        said = as_user(f"cd coplane-examples/bar_wall_3d/S && /usr/lib/coplane/levels/{level}/coplane run.yaml --backend serial")
        assert state_hash(said) == same_as and f"-march={level} " in said, said[-3000:]
    passed(f"the same bits from {' '.join(sorted(levels))}")


if __name__ == "__main__":
    if sys.argv[1] in ("this_build", "every_processor") and "COPLANE_OWN_MOUNTS" not in os.environ:
        if os.geteuid() != 0:
            skip("only root can install packages")
        # What is mounted goes with this process.
        os.execvpe("unshare", ["unshare", "--mount", sys.executable, *sys.argv], dict(os.environ, COPLANE_OWN_MOUNTS="1"))
    globals()[f"check_{sys.argv[1]}"]()
