#!/bin/sh
# Writes the pages and JSON Schemas that the programs print, after a change of keys. Usage: write-references.sh [FOLDER OF THE PROGRAMS]
set -e
programs=$(cd "${1:-$(dirname "$0")/../../build/bin}" && pwd)
cd "$(dirname "$0")/../../docs"
"$programs/coplane" --help-deck-markdown > user/deck.md
"$programs/coplane_point" --help-deck-markdown > user/point-deck.md
"$programs/coplane_mesh" --help-recipe-markdown > user/recipe.md
"$programs/coplane" --schema > schemas/deck.json
"$programs/coplane_point" --schema > schemas/point-deck.json
"$programs/coplane_mesh" --recipe-schema > schemas/recipe.json
"$programs/coplane_mesh" --split-schema > schemas/joint-recipe.json
"$programs/coplane_mesh" --blocks-schema > schemas/blocks-recipe.json
"$programs/coplane_mesh" --example-schema > schemas/example.json
