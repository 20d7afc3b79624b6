#!/bin/sh
# Usage: program-test.sh <coplane_mesh> <recipe> <model of Gmsh>: exit codes of the program as docs/user/exit-codes.md states them.
program=$1
recipe=$2
model=$3
expect()
{
  wanted=$1
  shift
  "$program" "$@" > output.txt 2>&1
  found=$?
  if [ $found -ne "$wanted" ]; then
    echo "coplane_mesh $*: exit code $found, expected $wanted"
    cat output.txt
    exit 1
  fi
}
expect 0 make "$recipe" -o mesh.e
expect 0 check mesh.e
cat > cuts.yaml <<'END'
joints: {slab_joint: {planes: {point: [0.6, 0], normal: [1, 0], tolerance: 0.03, box: {min: [0, -1], max: [2, 0]}}}}
END
expect 0 split mesh.e cuts.yaml -o split.e
expect 0 check split.e
expect 3 split mesh.e missing.yaml -o split.e
expect 4 split missing.e cuts.yaml -o split.e
expect 0 --help-split
expect 0 convert "$model" -o converted.e
expect 0 check converted.e
expect 4 convert missing.msh -o converted.e
expect 4 convert "$recipe" -o converted.e
expect 0 merge mesh.e mesh.e --prefix a_ --prefix b_ -o all.e
expect 0 check all.e
grep -q "a_slab" output.txt && grep -q "b_slab_top" output.txt || { cat output.txt; exit 1; }
expect 0 merge mesh.e mesh.e --prefix "" --prefix b_ -o all.e
expect 0 merge mesh.e mesh.e --join -o all.e
expect 4 merge mesh.e mesh.e -o all.e
expect 2 merge mesh.e mesh.e --prefix a_ -o all.e
expect 2 merge mesh.e mesh.e --join --weld 0 -o all.e
expect 2 merge mesh.e split.e -o mesh.e
expect 2 merge mesh.e -o all.e
expect 4 merge mesh.e missing.e -o all.e
cat > placed.yaml <<'END'
{dimension: 2, meshes: [{file: mesh.e, prefix: a_}, {file: mesh.e, prefix: b_, offset: [0, 3]}]}
END
expect 0 make placed.yaml -o placed.e
expect 0 check placed.e
expect 3 make placed.yaml -o placed.e --set meshes.0.scale=0
expect 2 make placed.yaml -o mesh.e
expect 0 --version
expect 0 --help-recipe
for option in --help-example --help-recipe-markdown --recipe-schema --split-schema --example-schema; do expect 0 $option; done
expect 0 make "$recipe" -o mesh.e --set title=other
expect 3 make "$recipe" -o mesh.e --set dimension=5
expect 3 example "$recipe"
expect 2 check
expect 4 check missing.e
expect 3 make missing.yaml -o mesh.e
expect 5 make "$recipe" -o no/such/folder/mesh.e
