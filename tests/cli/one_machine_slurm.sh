# A whole Slurm on 127.0.0.1, by and for whoever starts it, in the folder $1: munged, slurmctld, slurmd. Sourced. It runs
# without systemd and cgroups and touches nothing outside the folder.
PATH=$PATH:/usr/sbin:/sbin

start_slurm() {  # FOLDER
  cluster=$1
  mkdir -p -m 755 "$cluster" "$cluster"/{state,spool,munge}
  (umask 077 && head -c 1024 /dev/urandom >"$cluster/munge/key")
  export SLURM_CONF=$cluster/slurm.conf
  local ports
  mapfile -t ports < <(shuf -i 20000-29999 -n 2)
  cat >"$SLURM_CONF" <<CONF
ClusterName=mill
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=localhost Default=YES MaxTime=INFINITE State=UP
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$cluster/munge/socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.pid
CONF
  munged --foreground --force --key-file="$cluster/munge/key" --socket="$cluster/munge/socket" \
    --pid-file="$cluster/munge/pid" --seed-file="$cluster/munge/seed" >"$cluster/munged.log" 2>&1 &
  munged_pid=$!
  start_controller
  slurmd -D -N localhost >"$cluster/slurmd.log" 2>&1 &
  slurmd_pid=$!
  for _ in $(seq 60); do
    [ "$(sinfo --noheader -o %t 2>/dev/null)" = idle ] && return
    sleep 0.5
  done
  echo "no Slurm came up: $(tail -qn 2 "$cluster"/*.log)" >&2
  return 1
}

start_controller() {
  slurmctld -D >>"$cluster/slurmctld.log" 2>&1 &
  slurmctld_pid=$!
}

stop_controller() {
  kill "$slurmctld_pid" 2>/dev/null
  wait "$slurmctld_pid" 2>/dev/null
}

stop_slurm() {
  kill -0 "$slurmctld_pid" 2>/dev/null && scancel --me
  for _ in $(seq 50); do
    kill -0 "$slurmctld_pid" 2>/dev/null && [ -n "$(squeue --noheader 2>/dev/null)" ] || break
    sleep 0.2
  done
  kill "$slurmd_pid" 2>/dev/null
  wait "$slurmd_pid" 2>/dev/null
  stop_controller
  kill "$munged_pid" 2>/dev/null
  wait "$munged_pid" 2>/dev/null
}
