#!/usr/bin/env bash
# The slice mill's measured power as EXPERIMENTS.toml: the 35 % series to fit, the 25 % series held out.
#   bench/slice_experiments.sh slice_mill_55cm_power.csv > experiments.toml
# One standard deviation: the digitising uncertainty and 4 % of the power (a plane model's own error), in quadrature.
set -euo pipefail
awk -F, '
  /^#/ || /^speed/ { next }
  {
    printf "[[experiment]]\nname = \"J%s-%s\"\n", $3, $1
    printf "set = { \"mill.speed_rpm\" = %s, \"charge.count\" = %s }\n", $2, $4
    if ($3 == 25) print "hold_out = true"
    printf "power_W = %s\npower_uncertainty_W = %.3f\n\n", $5, sqrt($6 * $6 + (0.04 * $5) ^ 2)
  }' "${1:?give slice_mill_55cm_power.csv}"
