"""What packages declare: packages/PackagesList.cmake and packages/*/cmake/Dependencies.cmake. Needs the standard library only."""

import re
from pathlib import Path

PACKAGES = Path(__file__).resolve().parent.parent
KEYWORDS = ("PACKAGES", "LIBRARIES", "PRIVATE_LIBRARIES")


def without_comments(text):
    return re.sub(r"#[^\n]*", "", text)


def packages_bottom_to_top():
    text = without_comments((PACKAGES / "PackagesList.cmake").read_text())
    return re.search(r"set\(COPLANE_PACKAGES\s+([^)]*)\)", text).group(1).split()


def declared(package):
    """What a package declares: for each of KEYWORDS the words after it, up to the next keyword."""
    text = without_comments((PACKAGES / package / "cmake" / "Dependencies.cmake").read_text())
    lists, keyword = {word: [] for word in KEYWORDS}, None
    for word in " ".join(re.findall(r"coplane_dependencies\(([^)]*)\)", text)).split():
        if word in KEYWORDS:
            keyword = word
        else:
            lists[keyword].append(word)
    return lists
