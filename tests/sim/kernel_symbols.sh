#!/usr/bin/env bash
# Fails where an object of sim/kernels that is compiled for more than every machine has offers the linker a function
# that another file might offer too, such as one on plain doubles: the linker keeps one of them for the whole program,
# which then ends on an older machine.
#   kernel_symbols.sh NM OBJECT...      objects of tumble_sim; those for special instruction sets are picked
set -euo pipefail
nm=$1
shift
seen=0 bad=0
for object; do
  case $object in
    *kernels/avx2.*) own='xsimd::avx2>' table=kAvx2Kernels ;;
    *kernels/avx512.*) own='xsimd::avx512f>' table=kAvx512Kernels ;;
    *) continue ;;
  esac
  symbols=$("$nm" -C --defined-only --extern-only "$object")
  grep -q "tumble::sim::$table\$" <<<"$symbols" || { echo "$object: no $table among its symbols" >&2; exit 1; }
  seen=$((seen + 1))
  # What names the instruction set is its own; the last is gcc's reference to the run-time library, no code.
  strange=$(grep -vF -e "$own" -e "tumble::sim::$table" -e DW.ref.__gxx_personality_v0 <<<"$symbols" || true)
  [[ -z $strange ]] || { echo "$object shares with files for every machine:"; echo "$strange"; bad=1; } >&2
done
((seen == 2)) || { echo "found $seen of the 2 objects" >&2; exit 1; }
exit $bad
