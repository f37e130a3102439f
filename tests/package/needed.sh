#!/bin/sh
# needed.sh READELF NM LIBRARY ALLOWED: what the shared library loads and what it exports. Prints TAP.
# ALLOWED is one argument: names of libraries, without version, separated by blanks.
readelf=$1 nm=$2 library=$3 allowed=$4
status=0
echo 1..2

excess=''
for name in $("$readelf" -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\].*/\1/p'); do
    case " $allowed " in
    *" ${name%%.so*} "*) ;;
    *) excess="$excess $name" ;;
    esac
done
if [ -z "$excess" ]; then
    echo "ok 1 - loads nothing but $allowed"
else
    echo "not ok 1 - loads nothing but $allowed"
    echo "# also loads:$excess"
    status=1
fi

exported=$("$nm" -D --defined-only "$library" | awk '{ print $NF }')
foreign=$(echo "$exported" | grep -v '^sluice[A-Z]' | tr '\n' ' ')
if [ -n "$exported" ] && [ -z "$foreign" ]; then
    echo "ok 2 - exports only names that begin with sluice"
else
    echo "not ok 2 - exports only names that begin with sluice"
    echo "# exports: ${foreign:-nothing}"
    status=1
fi
exit $status
