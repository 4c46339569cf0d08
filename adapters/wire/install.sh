#!/bin/sh
# Installs what a solver of the user's own is compiled against, below a folder:
#   install.sh PREFIX LIBRARY        LIBRARY: the libcalcine_wire.a that was built
# PREFIX/include/calcine_wire.h, PREFIX/lib/libcalcine_wire.a, PREFIX/lib/pkgconfig/calcine-wire.pc and the examples with
# a Makefile in PREFIX/share/calcine/examples. `cargo xtask install --prefix PREFIX` builds the library and calls this.
# The folder may be moved: pkg-config finds everything relative to the .pc file.
set -eu
if [ $# -ne 2 ]; then
    echo "usage: $0 PREFIX LIBRARY" >&2
    exit 2
fi
own=$(dirname "$0")
version=$(sed -n 's/^#define CALCINE_WIRE_VERSION \([0-9]*\)u$/\1/p' "$own/include/calcine_wire.h")
examples=$1/share/calcine/examples
mkdir -p "$1/include" "$1/lib/pkgconfig" "$examples"
cp "$own/include/calcine_wire.h" "$1/include/"
cp "$2" "$1/lib/libcalcine_wire.a"
for file in Makefile solver.h column_gas.c ballistic_particles.c column.toml; do
    cp "$own/examples/$file" "$examples/"
done
cat >"$1/lib/pkgconfig/calcine-wire.pc" <<EOF
prefix=\${pcfiledir}/../..
includedir=\${prefix}/include
libdir=\${prefix}/lib

Name: calcine-wire
Description: Link between Calcine's coordinator and a solver
Version: $version
Cflags: -I\${includedir}
Libs: -L\${libdir} -lcalcine_wire -lgcc_s -lutil -lrt -lpthread -lm -ldl
EOF
