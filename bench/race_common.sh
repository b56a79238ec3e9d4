# shellcheck shell=bash
# For race.sh and scaling.sh, which source it at the root of the repository: the peers' mill with its states.
shopt -s inherit_errexit
source bench/median.sh
peers=${TUMBLE_PEERS:-../shared/peers}
race_mill=${RACE_MILL:-build/release/bench/race_mill}
kept=${RACE_STATES:-build/race}  # states that took minutes to make
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export TMPDIR=$work

[[ -x $race_mill ]] || { echo "no $race_mill: build it, or set RACE_MILL" >&2; exit 1; }
[[ -f $peers/common/gen.py ]] || { echo "no peers in $peers: set TUMBLE_PEERS; without them there are no states" >&2; exit 0; }

gen() { python3 "$peers/common/gen.py" "$@" >"$work/gen.log"; }

# The peers' state of so many balls; where they have none, their loose lattice, turned for 2.5 s. In a large mill it falls
# so far that these springs would give by more than half a radius: stiffer ones take the fall.
state_of() {  # BALLS -> file
  local balls=$1 state
  for state in "$peers/common/states/t${balls}_ic07.csv.gz" "$kept/t$balls.csv"; do
    [[ ! -f $state ]] || { echo "$state"; return; }
  done
  echo "making a state of $balls balls in $kept, once" >&2
  gen lattice "$balls" "$work/lattice"
  gen export "$work/lattice/lattice.csv" "$work/lattice"
  mkdir -p "$kept"
  sed -i 's/^kn .*/kn 1.6e6/; s/^kt .*/kt 1.2e6/' "$work/lattice/case.txt"
  "$race_mill" "$work/lattice" 24000 5e-5 0.7 0.1 --export "$work/fallen.csv" >&2
  gen export "$work/fallen.csv" "$work/lattice"
  "$race_mill" "$work/lattice" 13000 1e-4 0.7 0.1 --export "$state.part" >&2
  mv "$state.part" "$state"
  rm -r "$work/lattice"
  echo "$state"
}

case_of() {  # BALLS [STATE] -> folder
  local folder=$work/case$1
  [[ -d $folder ]] || gen export "${2:-$(state_of "$1")}" "$folder"
  echo "$folder"
}
