#!/usr/bin/env bash
# A bundled example through `tumble diagnose`, from nothing: its library, the verdict, the strength, the gap.
#   tests/cli/diagnose_example.sh TUMBLE_BINARY SOURCE_FOLDER
source "$(dirname "$0")/promises.sh"
example=$source/examples/diagnose/artefact
done_by diagnose "$example/mill.toml" --measured "$example/experiments.toml" -o out --library library --blocks 2 --seeds 4
first() { grep -m1 "\"$1\"" "$2" | sed -E 's/.*"'"$1"'": *"?([^",}]*).*/\1/'; }
for key in verdict name; do
  [ "$(first $key out/verdict.json)" = "$(first $key "$example/expected.json")" ] ||
    fail "$key is $(first $key out/verdict.json)"
done
awk -v found="$(first value out/verdict.json)" -v true="$(first value "$example/expected.json")" \
  'BEGIN { exit !(found / true > 0.9 && found / true < 1.1) }' || fail "strength $(first value out/verdict.json)"
# Gaps: fit and held out, before and after.
grep -A2 '"before"\|"after"' out/verdict.json | grep -o '"hold_out": [0-9.]*' | head -2 | awk '{ print $2 }' |
  paste -sd' ' | awk '{ exit !($1 > 2 && $2 < 1.5) }' || fail "the gap: $(grep -m2 hold_out out/verdict.json)"
grep -q 'camera_scale = -0.02' out/model.toml || fail "model.toml: $(grep -n scale out/model.toml)"
# The same again changes nothing that is there, and simulates no library.
before=$(find library -type f -exec stat -c '%n %Y' {} + | sort)
refused "force" diagnose "$example/mill.toml" --measured "$example/experiments.toml" -o out --library library
[ "$before" = "$(find library -type f -exec stat -c '%n %Y' {} + | sort)" ] || fail "the library was touched"
[ $failures -eq 0 ] && echo "the example's verdict is as expected"
exit $failures
