#!/usr/bin/python3
"""Makes a searchable site of all Markdown pages: the manual, theory, examples, verification, and the READMEs beside the sources.

    packages/cmake/make-site.py build/site
    python3 -m http.server --directory build/site

The folder is replaced. Pages keep their places, so links are the ones of the source tree; a link that leads nowhere, to a page, a heading or a
file, ends with exit code 1. Added are docs/keys.html, the keys of decks and recipes by topic and from A to Z, made from docs/schemas, and the
search. Needs Debian's mkdocs, python3-pymdownx and libjs-katex; packages/cmake/dependencies.sh installs them.
"""

import html
import html.parser
import json
import logging
import os
import pathlib
import re
import shutil
import sys
import tempfile
import urllib.parse

TOP = pathlib.Path(__file__).resolve().parents[2]
KATEX = pathlib.Path("/usr/share/javascript/katex")
PAGES = ["README.md", "docs/**/*.md", "apps/*/README.md", "packages/*/README.md", "exodus_inputs/**/README.md", "tests/**/README.md"]
JQUERY = pathlib.Path("/usr/share/javascript/jquery/jquery.min.js")
# Formulas are drawn; wide tables can be scrolled.
SCRIPT = """document.addEventListener("DOMContentLoaded", () => {
  renderMathInElement(document.body, {delimiters: [{left: "\\\\(", right: "\\\\)", display: false}, {left: "\\\\[", right: "\\\\]", display: true}]});
  for (const table of document.querySelectorAll(".rst-content table")) {
    table.classList.add("docutils");
    const wide = document.createElement("div");
    wide.className = "wy-table-responsive";
    table.replaceWith(wide);
    wide.append(table);
  }
});
"""
STYLE = """.wy-nav-content{max-width:1100px}.wy-table-responsive table td,.wy-table-responsive table th{white-space:normal}
.rst-content code{white-space:pre-wrap;overflow-wrap:break-word}
"""
# Files with keys, by their schemas: what they are, and the page of their reference.
FILES = {
    "deck": ("deck", "user/deck.md"),
    "recipe": ("recipe of a mesh", "user/recipe.md"),
    "joint-recipe": ("recipe of joints", "user/recipe.md"),
    "blocks-recipe": ("recipe of blocks", "user/recipe.md"),
    "example": ("example.yaml", "user/recipe.md"),
    "point-deck": ("deck of coplane_point", "user/point-deck.md"),
}
# In the search.
WEIGHTS = {"docs/user/": 3, "docs/keys": 2, "docs/glossary": 2, "docs/developer/": 0.5, "docs/CHANGELOG": 0.5, "tests/": 0.3, "packages/": 0.3, "apps/": 0.5}
TOPICS = {
    "The problem": ["deck: title mesh geometry define"],
    "Meshes": ["recipe: title define dimension parts meshes", "blocks-recipe: title define dimension seed up north domain openings joints elements slivers"],
    "Sets of nodes and faces": ["recipe: node_sets side_sets", "blocks-recipe: node_sets side_sets"],
    "Materials": ["deck: materials blocks", "point-deck: title define materials material_paths"],
    "Joints and contact": ["deck: joints contact", "joint-recipe: define joints", "point-deck: joints joint_paths elements"],
    "Loads, supports, state at the start": ["deck: conditions lines initial gravity"],
    "Time, stages, damping, shocks": ["deck: time stages damping viscosity"],
    "What is written": ["deck: output history"],
    "Long and parallel runs": ["deck: checkpoint partition"],
    "Sizes and variants": ["example: title recipe joints deck ranks default sizes variants pictures check summary"],
}


def slug(heading, separator="-"):
    """Name of a heading in links, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


# --- keys ----------------------------------------------------------------------------------------------


def keys_in(schema, path=""):
    """Path and description of every key of a JSON Schema, in its order; some come more than once."""
    either = schema.get("anyOf", [])
    for part in [part for part in either if "items" in part] or either:  # one item alone is short for a list
        yield from keys_in(part, path)
    for inner, word in (("items", "<index>"), ("additionalProperties", "<name>")):
        if isinstance(schema.get(inner), dict):
            yield from keys_in(schema[inner], f"{path}.{word}")
    for rules in (schema, *(rule.get("then", {}) for rule in schema.get("allOf", []))):
        for name, key in rules.get("properties", {}).items():
            if isinstance(key, dict) and "description" in key:
                here = f"{path}.{name}".lstrip(".")
                yield here, key["description"]
                yield from keys_in(key, here)


def groups_of(file):
    """Descriptions of keys by name, by path of the group that holds them."""
    groups = {}
    for path, description in keys_in(json.loads((TOP / f"docs/schemas/{file}.json").read_text())):
        group, _, name = path.rpartition(".")
        groups.setdefault(group, {}).setdefault(name, description.partition(": ")[0])
    return groups


def heading_of(file, group, pages):
    """Link to the section of a group: the place of its heading among equal ones counts."""
    page = FILES[file][1]
    if not group:
        return page
    first = {"joint-recipe": "# Recipes of joints", "blocks-recipe": "# Recipes of blocks", "example": "# Examples"}.get(file, "")
    text = pages[f"docs/{page}"]
    own = f"## `{group}`"
    place = text.index(own + "\n", text.index(first))
    before = text[:place].count(own + "\n")
    return f"{page}#{slug(group)}" + (f"_{before}" if before else "")


def cell(text):
    """Plain text in a table of Markdown."""
    return re.sub(r"([|<>*_])", r"\\\1", text)


def keys_page(pages):
    """The keys by topic, and from A to Z."""
    groups = {file: groups_of(file) for file in FILES}
    told = [(file, section) for entries in TOPICS.values() for entry in entries for file, _, names in [entry.partition(": ")] for section in names.split()]
    there = [(file, section) for file in FILES for section in groups[file][""]]
    if sorted(told) != sorted(there):
        sys.exit(f"make-site: TOPICS does not have every section once: {sorted(set(told) ^ set(there))}")
    lines = ["# Keys by topic", "", "Every key of decks and recipes, made from the schemas that check them. Each section leads to its reference. `coplane --help-deck TOPIC` "
             "prints the same in the terminal. [From A to Z](#from-a-to-z).", ""]  # fmt: skip
    where = {}
    for topic, entries in TOPICS.items():
        lines += [f"## {topic}", "", "| file | section | keys |", "|---|---|---|"]
        for entry in entries:
            file, _, sections = entry.partition(": ")
            for section in sections.split():
                inner = [group for group in groups[file] if group == section or group.startswith(section + ".")]
                meaning, link = groups[file][""][section], heading_of(file, inner[0] if inner else "", pages)
                where.setdefault(section, []).append((file, "", link, meaning))
                if not inner:
                    lines.append(f"| {FILES[file][0]} | [`{section}`]({link}) | {cell(meaning)} |")
                for group in inner:
                    link, keys = heading_of(file, group, pages), groups[file][group]
                    lines.append(f"| {FILES[file][0]} | [`{group}`]({link}) | {', '.join(f'`{name}`' for name in keys)} |")
                    for name, meaning in keys.items():
                        where.setdefault(name, []).append((file, group, link, meaning))
        lines.append("")
    lines += ["## From A to Z", "", "| key | of | meaning |", "|---|---|---|"]
    for name in sorted(where):
        for file, group, link, meaning in where[name]:
            place = f"[{FILES[file][0]}{f': `{group}`' if group else ''}]({link})"
            lines.append(f"| `{name}` | {place} | {cell(meaning)} |")
    return "\n".join(lines) + "\n"


# --- pages ---------------------------------------------------------------------------------------------


def links_in(text):
    """Targets of links to other files."""
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    return [target for target in re.findall(r"\]\(([^)#\s]+)", text) if "://" not in target]


def adapted(text):
    """For Python-Markdown, which wants lists to follow an empty line and four blanks before what lies within an item, and for KaTeX, which wants
    braces around an index \\max."""
    text = re.sub(r"([_^])(\\(?:max|min))\b", r"\1{\2}", text)
    lines, is_code, last = [], False, ""
    for line in text.split("\n"):
        is_code = is_code != line.lstrip().startswith("```")
        is_item = re.match(r"(- |\d+\. )", line)
        if is_item and last and not re.match(r"(- |\d+\. |  )", last) and not is_code:
            lines.append("")
        if not is_code and re.match(r"  (- |\d+\. )", line):
            line = "  " + line
        lines.append(line)
        last = line
    return "\n".join(lines)


def stage(folder):
    """Puts all pages, and the files that they link to, into a folder. Returns the texts of the pages by name."""
    pages = {str(path.relative_to(TOP)): path.read_text(encoding="utf-8") for pattern in PAGES for path in sorted(TOP.glob(pattern))}
    texts = dict(pages, **{"docs/keys.md": keys_page(pages)})
    for name, text in texts.items():
        for target in links_in(text):
            file = pathlib.Path(os.path.normpath(TOP / pathlib.Path(name).parent / target))
            place = folder / file.relative_to(TOP)
            if file.is_file() and file.suffix != ".md":
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(file, place)
            elif (file / "README.md").is_file():
                text = text.replace(f"]({target})", f"]({target.rstrip('/')}/README.md)")
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(adapted(text), encoding="utf-8")
    add_assets(folder)
    return texts


def add_assets(folder):
    """Scripts and styles. Pages of Debian's theme ask for two scripts that its package lacks."""
    shutil.copytree(KATEX, folder / "assets/katex", ignore=shutil.ignore_patterns("*.mjs", "katex.js", "katex.css"))
    (folder / "assets/site.css").write_text(STYLE)
    (folder / "js").mkdir()
    shutil.copy(JQUERY, folder / "js/jquery-3.6.0.min.js")
    (folder / "js/theme_extra.js").write_text(SCRIPT)


def navigation(texts):
    """As the table of docs/README.md has it, with all other pages behind."""
    groups, group = {}, ""
    for reader, page in re.findall(r"^\| *([^|]*?) *\| \[[^]]*\]\(([^)]*\.md)\)", texts["docs/README.md"], flags=re.M):
        group = reader or group
        groups.setdefault({"everyone": "Start"}.get(group, group.capitalize()), []).append(f"docs/{page}")
    groups["Start"] = ["README.md", "docs/README.md", *groups.get("Start", []), "docs/keys.md", "docs/CHANGELOG.md"]
    forgotten = [name for name in texts if name.startswith("docs/") and name not in sum(groups.values(), [])]
    if forgotten:
        sys.exit(f"make-site: docs/README.md does not list {', '.join(forgotten)}")
    for title, begin in (("Verification cases", "tests/verification/"), ("Validation cases", "tests/validation/"), ("Other tests", "tests/"),
                         ("Examples beside their decks", "exodus_inputs/"), ("Packages", "packages/"), ("Programs", "apps/")):  # fmt: skip
        groups[title] = [name for name in texts if name.startswith(begin) and name not in sum(groups.values(), [])]
    # A page stands where it was named first.
    seen = set()
    return [{title: [name for name in names if not (name in seen or seen.add(name))]} for title, names in groups.items()]


# --- the site ------------------------------------------------------------------------------------------


class Anchors(html.parser.HTMLParser):
    """Links of a page, and the names of its places."""

    def __init__(self, path):
        super().__init__()
        self.links, self.names = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.names.update(filter(None, [attributes.get("id")]))
        link = attributes.get("href") or attributes.get("src")
        if link:
            self.links.append(link)


def dead_links(site):
    """Links of the pages to files and places of the site that are not there, and to styles or scripts elsewhere."""
    pages = {path: Anchors(path) for path in sorted(site.rglob("*.html"))}
    dead = []
    for path, page in pages.items():
        for link in page.links:
            address = urllib.parse.urlsplit(link)
            target = pathlib.Path(os.path.normpath(path.parent / urllib.parse.unquote(address.path))) if address.path else path
            if address.scheme or address.netloc or path.name in ("404.html", "search.html"):
                continue
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                dead.append(f"{path.relative_to(site)}: {link}")
            elif address.fragment and target in pages and urllib.parse.unquote(address.fragment) not in pages[target].names:
                dead.append(f"{path.relative_to(site)}: {link}: no such heading")
    return dead


def tune_search(folder):
    """Results of the search are sections: a page as a whole, which would stand there beside its first section, goes, and titles name the page.
    Words of titles and the user's manual count more than others, pages beside sources less."""
    index, worker = folder / "search_index.json", folder / "worker.js"
    found = json.loads(index.read_text(encoding="utf-8"))
    for entry in found["docs"]:
        entry["title"] = html.unescape(entry["title"])
    pages = {entry["location"]: entry["title"] for entry in found["docs"] if "#" not in entry["location"]}
    sections = [entry for entry in found["docs"] if "#" in entry["location"]]
    alone = pages.keys() - {entry["location"].partition("#")[0] for entry in sections}
    for entry in sections:
        page = pages[entry["location"].partition("#")[0]]
        if entry["title"] != page:
            entry["title"] = f"{page}: {entry['title']}"
    for entry in found["docs"]:
        entry["boost"] = next((boost for begin, boost in WEIGHTS.items() if entry["location"].startswith(begin)), 1)
    found["docs"] = [entry for entry in found["docs"] if "#" in entry["location"] or entry["location"] in alone]
    index.write_text(json.dumps(found), encoding="utf-8")
    text = worker.read_text()
    for old, new in (("this.add(doc);", "this.add(doc, {boost: doc.boost});"), ("this.field('title');", "this.field('title', {boost: 3});")):
        if old not in text:
            sys.exit(f"make-site: this mkdocs has another search: {worker.name} has no {old}")
        text = text.replace(old, new)
    worker.write_text(text)


def build(site):
    try:
        import pymdownx  # noqa: F401
        from mkdocs.commands.build import build as mkdocs_build
        from mkdocs.config import load_config
    except ImportError as error:
        sys.exit(f"make-site: {error}. apt-get install mkdocs python3-pymdownx libjs-katex (Debian), and start this with /usr/bin/python3.")
    with tempfile.TemporaryDirectory() as folder:
        pages = pathlib.Path(folder, "pages")
        texts = stage(pages)
        config = pathlib.Path(folder, "mkdocs.yml")
        config.write_text("site_name: Coplane\n")
        mkdocs_build(load_config(
            str(config), docs_dir=str(pages), site_dir=str(site), strict=True, use_directory_urls=False, nav=navigation(texts),
            theme={"name": "readthedocs", "highlightjs": False, "navigation_depth": 2, "collapse_navigation": True},
            plugins=["search"], extra_css=["assets/katex/katex.min.css", "assets/site.css"],
            extra_javascript=["assets/katex/katex.min.js", "assets/katex/contrib/auto-render.js"],
            markdown_extensions=["tables", "sane_lists", {"toc": {"slugify": slug}}, {"pymdownx.arithmatex": {"generic": True}}, "pymdownx.superfences"],
        ))  # fmt: skip
        tune_search(site / "search")


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    site = pathlib.Path(sys.argv[1]).resolve()
    if site.exists() and any(site.iterdir()) and not (site / "sitemap.xml").exists():
        sys.exit(f"make-site: {site} has files that are no site. Nothing was changed; choose another folder.")
    logging.basicConfig(level=logging.WARNING, format="make-site: %(message)s")
    build(site)
    dead = dead_links(site)
    if dead:
        sys.exit("make-site: links that lead nowhere:\n" + "\n".join(dead))
    print(f"{len(list(site.rglob('*.html')))} pages in {site}; python3 -m http.server --directory {site} shows them, with the search")


if __name__ == "__main__":
    main()
