#!/bin/sh
# test_demand_pbrt.sh DEMAND_PBRT FOLDER DATA
#
# Renders small pictures and checks what loading on demand must show: they are equal bit for bit to
# what everything loaded before gives, and nothing is made that no ray needs. DATA has scenes of
# pbrt; without it only scenes that are written here are rendered. tests/oracle compares more
# scenes with everything loaded before. Prints TAP.
set -eu
program=$1 folder=$2 data=${SLUICE_TEST_DATA:-$3}/pbrt

rm -rf "$folder"
mkdir -p "$folder"
number=0 fact='' failed=0 status_of_all=0

complain() {
    echo "# $*"
    failed=1
}

# Ends the fact that was begun, if any, and begins one.
begin() { # fact
    if [ -n "$fact" ]; then
        number=$((number + 1))
        [ "$failed" -eq 0 ] && echo "ok $number - $fact" || echo "not ok $number - $fact"
        [ "$failed" -eq 0 ] || status_of_all=1
    fi
    fact=$1 failed=0
}

end_all() {
    begin ''
    echo "1..$number"
    exit $status_of_all
}

refuse() {
    status=0
    "$program" --file "$folder/refused.png" "$@" >/dev/null 2>&1 || status=$?
    [ "$status" -eq 2 ] || complain "not refused: $*"
}
begin wrong_options_are_refused
refuse
refuse x.pbrt --no-such-option
refuse x.pbrt --dim 96
refuse x.pbrt --bg 1/2
refuse x.pbrt --bg=-1/0/0
refuse x.pbrt --render-mode far
refuse x.pbrt --debug 3
refuse x.pbrt --path rays
refuse x.pbrt --preload --budget 1M
refuse x.pbrt --preload --material-budget 1M

render() { # name, scene, options
    name=$1 scene=$2
    shift 2
    status=0
    "$program" "$scene" --dim 64x48 --json --cache "$folder/cache" --file "$folder/$name.pfm" \
        --verbose-loading "$@" >"$folder/$name.json" 2>"$folder/$name.log" || status=$?
}

succeeds() {
    [ "$status" -eq 0 ] || { complain "$name: status $status"; sed 's/^/# /' "$folder/$name.log"; }
    check pixels_missing 'v == 0'
}

value() { # figure
    sed -n "s/.*\"$1\", \"value\": \([^,]*\),.*/\1/p" "$folder/$name.json"
}

# A figure of the last picture must satisfy an awk condition on v.
check() { # figure, condition
    awk -v v="$(value "$1")" 'BEGIN { v = v == "" ? "none" : v + 0; exit !(v != "none" && ('"$2"')) }' ||
        complain "$name: $1 is $(value "$1"), but must satisfy: $2"
}

says() { # pattern
    grep -q -e "$1" "$folder/$name.log" || complain "$name: nobody said: $1"
}

never_says() {
    ! grep -q -e "$1" "$folder/$name.log" || complain "$name: was loaded although no ray needs it"
}

equals() { # name of another picture
    cmp -s "$folder/$name.pfm" "$folder/$1.pfm" || complain "$name: is not the picture $1"
}

# Scenes of this test: meshes and a picture that cannot be read, and two meshes that are fine.
write_ply() { # name, third coordinate of the last vertex, faces, a face
    cat >"$folder/$1" <<END
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face $3
property list uchar int vertex_indices
end_header
-1 0 -1
1 0 -1
0 0 $2
$4
END
}
write_ply good.ply 1 1 '3 0 1 2'
write_ply nan.ply nan 1 '3 0 1 2'
write_ply range.ply 1 1 '3 0 1 3'
write_ply none.ply 1 0 ''
echo 'this is no picture' >"$folder/lost.png"
head -c 150 "$folder/good.ply" >"$folder/cut.ply"
cat >"$folder/own.pbrt" <<'END'
LookAt 0 -5 0  0 0 0  0 0 1
Camera "perspective" "float fov" 45
Film "image" "integer xresolution" 64 "integer yresolution" 48
WorldBegin
LightSource "distant" "point from" [ 0 -1 1 ]
Material "matte" "rgb Kd" [ .8 .2 .2 ]
Shape "plymesh" "string filename" "good.ply"
Shape "plymesh" "string filename" "nan.ply"
Shape "plymesh" "string filename" "cut.ply"
Shape "plymesh" "string filename" "missing.ply"
AttributeBegin
Scale 1 0 1
Shape "sphere"
AttributeEnd
Translate 0 4 0
Shape "sphere" "float radius" .2
Translate 0 -5 0
Shape "plymesh" "string filename" "range.ply"
Shape "plymesh" "string filename" "none.ply"
Shape "trianglemesh" "integer indices" [ 0 1 3 ] "point P" [ -1 0 -1 1 0 -1 0 0 1 ]
Texture "lost" "color" "imagemap" "string filename" "lost.png"
Material "matte" "texture Kd" "lost"
Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point P" [ -.3 0 -.9  .3 0 -.9  0 0 -.5 ]
WorldEnd
END

begin what_cannot_be_read_is_named_and_the_rest_is_rendered
validation=--validation
render own "$folder/own.pbrt" $validation
if [ "$status" -ne 0 ] && grep -q VK_ERROR_LAYER_NOT_PRESENT "$folder/own.log"; then
    echo "# there are no validation layers: rendering without them"
    validation=
    render own "$folder/own.pbrt"
fi
[ "$status" -ne 77 ] || { echo "1..0 # SKIP no device traces rays"; exit 0; }
succeeds
for line in 8 9 10 13 18 19 20 21; do
    says "own.pbrt:$line:"
done
check shapes_placed 'v == 4' # not that without faces
check geometries_built 'v == 2' # the ball is behind the triangle
check materials_realized 'v == 2'
check textures_failed 'v == 1'
render own-preload "$folder/own.pbrt" --preload
succeeds
check launches 'v == 1'
check geometries_built 'v == 3'
equals own

# Without ray tracing of the device: trees of ours in a compute shader.
begin the_compute_path_leaves_out_what_cannot_be_read
render own-compute "$folder/own.pbrt" $validation --path compute
succeeds
check ray_tracing_pipeline 'v == 0'
check geometries_built 'v == 2'
check materials_realized 'v == 2'
render own-compute-preload "$folder/own.pbrt" --path compute --preload
succeeds
check geometries_built 'v == 3'
equals own-compute

begin incomplete_pictures_are_an_error
render early "$folder/own.pbrt" --warmup 0
[ "$status" -eq 1 ] || complain "an incomplete picture is no error"
check launches 'v == 1'
check pixels_missing 'v > 0'

# The background, and without a camera pbrt's own.
begin scenes_without_shapes_show_the_sky
printf 'WorldBegin\nWorldEnd\n' >"$folder/empty.pbrt"
render empty "$folder/empty.pbrt" --bg 0.5/0.25/1
succeeds
says 'no shape can be seen'
check shapes_placed 'v == 0'
render empty-compute "$folder/empty.pbrt" --bg 0.5/0.25/1 --path compute
succeeds
equals empty
render broken /dev/null
[ "$status" -eq 1 ] || complain "a scene that cannot be read is no error"

# A scene's pictures: on demand, and everything before.
scene() { # name, file, options
    scene_name=$1 scene_file=$2
    shift 2
    render "$scene_name-preload" "$scene_file" --preload "$@"
    succeeds
    render "$scene_name" "$scene_file" "$@"
    succeeds
    equals "$scene_name-preload"
}

if [ ! -d "$data/made" ]; then
    echo "# there are no scenes at $data: only those of this test were rendered"
    end_all
fi

# With one shape a box, with its alpha and its diffuse texture four launches.
begin a_cube_with_alpha_takes_at_most_five_launches
scene cube "$data/optix-toolkit/diffuse-alpha.pbrt" $validation
check launches 'v <= 5'
check materials_realized 'v == 1'
check alphas_realized 'v == 1'

begin nothing_is_opened_behind_leaves
render leaves "$data/made/alpha/leaf-cards.pbrt"
succeeds
never_says never-
check textures_opened 'v == 6'
check geometries_built 'v == 6'

begin nothing_is_made_behind_a_wall
render wall "$data/made/occlusion/wall.pbrt"
succeeds
never_says never-
check shapes_placed 'v == 64'
check shapes_entered 'v == 4'
check geometries_built 'v == 4'
check materials_realized 'v == 2'
check textures_opened 'v == 1'

# Memory for one mesh and a half: those that rays have not hit for longest leave.
begin a_budget_gives_the_same_picture
render wall-budget "$data/made/occlusion/wall.pbrt" --budget 100K
succeeds
equals wall
check geometries_evicted 'v > 0'
check geometry_bytes 'v <= 100 * 1024'

# Memory for half of the materials and alphas that are seen.
begin a_budget_of_materials_gives_the_same_picture
render leaves-budget "$data/made/alpha/leaf-cards.pbrt" --material-budget 2K
succeeds
equals leaves
check materials_evicted 'v > 0'
check material_bytes 'v <= 2048'
check textures_opened 'v == 6'

# The dump has a line for each shape in the world; counts have the names of the OptiX Toolkit.
begin coarse_boxes_give_the_same_picture
render wood "$data/made/instances/wood.pbrt" --dump "$folder/wood.txt" --statistics "$folder/wood.json.txt"
succeeds
check shapes_placed 'v == 1676'
check shapes_entered 'v < 1100'
[ "$(wc -l <"$folder/wood.txt")" -eq 1676 ] || complain "$name: the dump has $(wc -l <"$folder/wood.txt") lines"
for key in numFramesRendered geometryCache numTriangles proxyFactory numInstanceShapeProxiesCreated numMaterialsRealized \
    numObjectInstances; do
    grep -q "\"$key\":" "$folder/wood.json.txt" || complain "$name: no $key"
done
render wood-coarse "$data/made/instances/wood.pbrt" --proxy-granularity coarse
succeeds
equals wood

begin the_compute_path_gives_the_pictures_of_everything_loaded_before
scene leaves-compute "$data/made/alpha/leaf-cards.pbrt" --path compute
never_says never-
check textures_opened 'v == 6'
check geometries_built 'v == 6'
scene wall-compute "$data/made/occlusion/wall.pbrt" --path compute --render-mode path
never_says never-
render wall-compute-budget "$data/made/occlusion/wall.pbrt" --path compute --render-mode path --budget 100K
succeeds
equals wall-compute
check geometries_evicted 'v > 0'
render leaves-compute-budget "$data/made/alpha/leaf-cards.pbrt" --path compute --material-budget 2K
succeeds
equals leaves-compute
check materials_evicted 'v > 0'
scene wood-compute "$data/made/instances/wood.pbrt" --path compute $validation
check shapes_entered 'v < 1100'
render wood-compute-coarse "$data/made/instances/wood.pbrt" --path compute --proxy-granularity coarse \
    --cluster-size 16 --fly 3
succeeds
equals wood-compute

begin shapes_on_demand_are_those_loaded_before
scene shapes "$data/made/shapes/shapes.pbrt"
begin pictures_of_all_formats_are_those_loaded_before
scene formats "$data/made/textures/formats.pbrt"
check textures_failed 'v == 0'
begin paths_are_those_with_everything_loaded_before
scene stairs "$data/bitterli/veach-mis/scene-v4.pbrt" $validation --render-mode path --samples 2
begin materials_that_come_one_by_one_are_made_once
render room-near "$data/made/twins/room-v4.pbrt" --render-mode near --oneshot-material
succeeds
check materials_realized 'v == 6'
end_all
