#!/bin/sh
# pkgconfig.sh PREFIX PACKAGE SOURCE ARGUMENT...: builds SOURCE against PACKAGE as installed in PREFIX and runs it.
set -eu
prefix=$1 package=$2 source=$3
shift 3
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name "$package.pc")")
export PKG_CONFIG_PATH
case $source in
  *.c) compiler="${CC:-cc} -std=c99" ;;
  *) compiler="${CXX:-c++} -std=c++20" ;;
esac
# shellcheck disable=SC2046,SC2086
$compiler "$source" $(pkg-config --cflags --libs "$package") -lm -o "$package-consumer"
exec "./$package-consumer" "$@"
