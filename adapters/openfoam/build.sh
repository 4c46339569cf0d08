#!/bin/bash
# Builds libcalcineFoam.so, calcineGasFoam, calcineParcelFoam and OpenFOAM's buoyantPimpleFoam against Debian's OpenFOAM 1912. `cargo xtask setup`
# calls it with these variables:
#   HEADERS_DIR   OpenFOAM's src/ with an lnInclude folder in each library
#   WIRE_INCLUDE  folder of calcine_wire.h
#   WIRE_LIB      libcalcine_wire.a
#   OUT_DIR       where library and solver go; objects stay in OUT_DIR/objects
set -euo pipefail
cd "$(dirname "$0")"
: "${HEADERS_DIR:?} ${WIRE_INCLUDE:?} ${WIRE_LIB:?} ${OUT_DIR:?}"

src=$HEADERS_DIR/src
# Those of OpenFOAM's wmake/rules/linux64Gcc, and OMPI_SKIP_MPICXX for Debian's Open MPI.
flags=(-std=c++14 -m64 -DOPENFOAM=1912 -DWM_DP -DWM_LABEL_SIZE=32 -Dlinux64 -DWM_ARCH_OPTION=64
    -O2 -DNoRepository -DOMPI_SKIP_MPICXX -ftemplate-depth-100 -fPIC
    -Wall -Wextra -Wno-unused-parameter -Wno-old-style-cast -Wnon-virtual-dtor
    -I library -I calcineGasFoam -I calcineParcelFoam -I "$WIRE_INCLUDE")
for part in OpenFOAM OSspecific/POSIX finiteVolume meshTools thermophysicalModels/basic \
    thermophysicalModels/specie thermophysicalModels/reactionThermo thermophysicalModels/chemistryModel ODE \
    thermophysicalModels/radiation transportModels/compressible \
    TurbulenceModels/turbulenceModels TurbulenceModels/compressible \
    lagrangian/basic lagrangian/intermediate lagrangian/distributionModels dynamicMesh fileFormats surfMesh \
    thermophysicalModels/thermophysicalProperties thermophysicalModels/SLGThermo regionModels/regionModel \
    regionModels/surfaceFilmModels; do
    flags+=(-isystem "$src/$part/lnInclude")
done

# For the link to a coordinator that spawned the solver by MPI.
read -ra folders <<<"$(mpicc --showme:incdirs)"
for folder in "${folders[@]}"; do flags+=(-isystem "$folder"); done

objects=$OUT_DIR/objects
mkdir -p "$objects"
jobs=()
for folder in library calcineGasFoam calcineParcelFoam; do
    rebuild_after=$(ls -t build.sh library/*.H "$folder"/*.H "$WIRE_INCLUDE/calcine_wire.h" | head -n 1)
    for file in "$folder"/*.C; do
        object=$objects/$(basename "$file" .C).o
        if [ ! "$object" -nt "$file" ] || [ ! "$object" -nt "$rebuild_after" ]; then
            jobs+=("$file" "$object.part" "$object")
        fi
    done
done
# Two compilers at a time: each takes about half a GB.
((${#jobs[@]})) && printf '%s\0' "${jobs[@]}" | xargs -0 -n 3 -P 2 bash -c '
    echo "compile $(basename "${@: -3:1}")"
    g++ "${@:1:$#-3}" -c "${@: -3:1}" -o "${@: -2:1}" && mv "${@: -2:1}" "${@: -1}"' build "${flags[@]}" || ((${#jobs[@]} == 0))

echo "link the library and the solvers"
own() { for file in "$1"/*.C; do echo "$objects/$(basename "$file" .C).o"; done; }
# A new file takes the old one's place at once: a running solver keeps what it has opened.
mapfile -t library < <(own library)
g++ -shared -Wl,-soname,libcalcineFoam.so -o "$OUT_DIR/.libcalcineFoam.so" "${library[@]}" "$WIRE_LIB" \
    -Wl,--exclude-libs,ALL,--strip-debug -lcompressibleTurbulenceModels -lturbulenceModels -lcompressibleTransportModels \
    -lfluidThermophysicalModels -lfiniteVolume -lmeshTools -lOpenFOAM -lmpi \
    -lgcc_s -lutil -lrt -lpthread -lm -ldl
mv "$OUT_DIR/.libcalcineFoam.so" "$OUT_DIR/libcalcineFoam.so"
mapfile -t solver < <(own calcineGasFoam)
g++ -o "$OUT_DIR/.calcineGasFoam" "${solver[@]}" -L "$OUT_DIR" '-Wl,-rpath,$ORIGIN' \
    -Xlinker --add-needed -Xlinker --no-as-needed -lcalcineFoam -lfiniteVolume -lmeshTools \
    -lfluidThermophysicalModels -lcompressibleTransportModels -lturbulenceModels \
    -lcompressibleTurbulenceModels -lradiationModels -lspecie -lreactionThermophysicalModels -lchemistryModel -lODE -lOpenFOAM -lPstream -ldl -lm
mv "$OUT_DIR/.calcineGasFoam" "$OUT_DIR/calcineGasFoam"
mapfile -t parcels < <(own calcineParcelFoam)
g++ -o "$OUT_DIR/.calcineParcelFoam" "${parcels[@]}" -L "$OUT_DIR" '-Wl,-rpath,$ORIGIN' \
    -Xlinker --add-needed -Xlinker --no-as-needed -lcalcineFoam -lfiniteVolume -lmeshTools -llagrangian \
    -llagrangianIntermediate -lOpenFOAM -lPstream -ldl -lm
mv "$OUT_DIR/.calcineParcelFoam" "$OUT_DIR/calcineParcelFoam"

# Debian's buoyantPimpleFoam computes wrong velocities on all meshes that are not orthogonal: `inv(tensors) & vectors` of
# fvc::reconstruct writes its product over the vectors, through pointers that OpenFOAM 1912 declares __restrict__, and GCC 12
# vectorises it at -O3 in an order that reads what is overwritten. The same sources without that.
stock=$HEADERS_DIR/applications/solvers/heatTransfer/buoyantPimpleFoam
name=buoyantPimpleFoam
if [ ! "$OUT_DIR/$name" -nt "$stock/$name.C" ] || [ ! "$OUT_DIR/$name" -nt build.sh ]; then
    echo "compile $name"
    g++ "${flags[@]}" -w -fno-tree-vectorize -I "$stock" -isystem "$src/sampling/lnInclude" \
        -isystem "$src/atmosphericModels/lnInclude" -c "$stock/$name.C" -o "$objects/$name.o.part"
    mv "$objects/$name.o.part" "$objects/$name.o"
    g++ -o "$OUT_DIR/.$name" "$objects/$name.o" -Xlinker --add-needed -Xlinker --no-as-needed -lfiniteVolume -lfvOptions \
        -lmeshTools -lsampling -lcompressibleTransportModels -lfluidThermophysicalModels -lradiationModels -lspecie \
        -lturbulenceModels -lcompressibleTurbulenceModels -latmosphericModels -lOpenFOAM -lPstream -ldl -lm
    mv "$OUT_DIR/.$name" "$OUT_DIR/$name"
fi
