# shellcheck shell=bash
# Numbers, one a line -> "median (least - most)".
median() {
  sort -g | awk '{ v[NR] = $1 }
    END {
      if (NR == 0) { printf "nothing measured"; exit }
      printf "%.3g (%.3g - %.3g)", (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2, v[1], v[NR]
    }'
}
