"""The Debian packages. Argument: launcher, spack, this_build (these with what is built), or every_processor (builds packages/cmake/packaging/make-packages.sh,
and installs with apt in a system that debootstrap makes). Packages are installed in a root folder of their own, and used by somebody
without a home who can read neither the sources nor the build nor its Trilinos. Needs root; ends with 77 where that cannot be."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

SOURCE, BINARIES = (pathlib.Path(os.environ[name]) for name in ("COPLANE_SOURCE", "COPLANE_BIN"))
BUILD = BINARIES.parent
TRILINOS = pathlib.Path(re.search(r"^COPLANE_TRILINOS:\w+=(.*)", (BUILD / "CMakeCache.txt").read_text(), flags=re.M).group(1)).resolve()
LEVELS = ["x86-64-v4", "x86-64-v3", "x86-64-v2", "x86-64"]
SKIPPED = 77
ROOT = pathlib.Path("clean/root").absolute()
UPPER = ROOT.parent / "upper"
# Names that shells and scripts stumble over.
FOLDER = "/tmp/my runs (1) \u00e9"
MAIN_JOB = ["bar_wall_3d", "--size", "S", "--no-pictures", "--no-check", "--set", "time.end=3e-4"]


def run(command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    assert done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stdout[-4000:]}"
    return done.stdout


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def passed(what):
    print(f"passed: {what}", flush=True)


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


# The recipe of Spack: the one thing about it that can be said here.


def check_spack():
    """It is Python, and what it sets is there to be set."""
    recipe = (SOURCE / "packages/cmake/packaging/spack/packages/coplane/package.py").read_text()
    compile(recipe, "package.py", "exec")
    options = "".join(path.read_text() for path in (SOURCE / "packages/cmake").glob("*.cmake"))
    names = re.findall(r"define(?:_from_variant)?\(\"(\w+)\"", recipe)
    assert names and all(re.search(rf"(set|option)\({name} ", options) for name in names), names
    number = re.search(r"Coplane VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
    assert f'version("{number}")' in recipe, f"not of version {number}"
    passed(f"recipe of Spack: {' '.join(names)}")


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
    """The programs, the Python package, the main job, the manual pages and the completion, as somebody uses them."""
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
    for name in ("coplane", "coplane_mesh", "coplane_new", "coplane_pictures", "coplane_point", "coplane_report", "coplane_watch"):
        page = as_user(f"man -P cat {name}") if (ROOT / "usr/bin/man").exists() else run(["man", "-P", "cat", ROOT / f"usr/share/man/man1/{name}.1.gz"])
        assert re.search(rf"{name} - \w+", page) and "--help" in page, page
    complete = ". /usr/share/bash-completion/completions/{}; COMP_WORDS=({}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _coplane_programs; echo ${{COMPREPLY[*]}}"
    for words, expected in (("coplane --ba", "--backend"), ("coplane --backend ''", "serial threads"), ("coplane_mesh ma", "make"),
                            ("coplane_mesh make --o", "--output"), ("coplane report --no", "--no-pictures"), ("coplane de", "")):
        found = as_user(complete.format(words.split()[0], words)).strip()
        assert found == expected, f"{words}: {found}"
    passed("manual pages, completion")


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


def check_this_build():
    folder = pathlib.Path("packages").absolute()
    shutil.rmtree(folder, ignore_errors=True)
    # One of the two packages, not compressed, for speed; by somebody who shows nothing to others.
    run(["cpack", "-G", "DEB", "-B", folder, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none", "-D", "CPACK_COMPONENTS_ALL=programs;common"], cwd=BUILD, umask=0o077)
    package, = folder.glob("*.deb")
    passed(f"packed: {package.name}, {package.stat().st_size / 1e6:.0f} MB not compressed")
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
