# shellcheck shell=bash disable=SC2154
# To be sourced: a Slurm of this machine alone, in the folder $work, on free ports, gone when the shell ends. Needs
# root and the Debian packages slurm-wlm and munge; touches no other Slurm or munge of the machine.
#
#   work=$(mktemp -d); . one-machine.sh; start_slurm; sbatch --wait ...
slurm_pids=()

stop_slurm() {
  if [ "${SLURM_CONF-}" = "$work/slurm/slurm.conf" ]; then # otherwise these would speak to another Slurm
    scancel --quiet --user=root 2>/dev/null
    for _ in $(seq 50); do
      [ -n "$(squeue --noheader 2>/dev/null)" ] || break
      sleep 0.2
    done
  fi
  for pid in "${slurm_pids[@]}"; do kill "$pid" 2>/dev/null; done
  for pid in "${slurm_pids[@]}"; do wait "$pid" 2>/dev/null; done
  rm -rf "$work"
}

free_ports() { # how many
  python3 -c 'import socket, sys
sockets = [socket.socket() for _ in range(int(sys.argv[1]))]
for s in sockets: s.bind(("127.0.0.1", 0))
print(*(s.getsockname()[1] for s in sockets))' "$1"
}

until_true() { # seconds, what is waited for, command...
  local end=$((SECONDS + $1)) what=$2
  shift 2
  until "$@" >/dev/null 2>&1; do
    if [ $SECONDS -ge $end ]; then
      echo "$what: waited in vain" >&2
      return 1
    fi
    sleep 0.2
  done
}

start_slurm() {
  [ "$(id -u)" -eq 0 ] || { echo "needs root" >&2; return 1; }
  local program
  for program in munged slurmctld slurmd sbatch; do
    command -v $program >/dev/null || { echo "$program is missing: install slurm-wlm and munge" >&2; return 1; }
  done
  trap stop_slurm EXIT
  local run=$work/slurm ports
  mkdir -m 755 "$run" "$run/munge" "$run/state" "$run/spool"
  read -r -a ports < <(free_ports 2)
  (umask 077 && head -c 128 /dev/urandom >"$run/munge/key")
  # --force: the folder lies under /tmp, which others can write to.
  munged --foreground --force --key-file="$run/munge/key" --socket="$run/munge/socket" \
    --pid-file="$run/munge/pid" --log-file="$run/munge/log" --seed-file="$run/munge/seed" 2>"$run/munge/errors" &
  slurm_pids+=($!)

  cat >"$run/slurm.conf" <<CONF
ClusterName=onemachine
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmdPort=${ports[1]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$run/munge/socket
CredType=cred/munge
StateSaveLocation=$run/state
SlurmdSpoolDir=$run/spool
SlurmctldPidFile=$run/slurmctld.pid
SlurmdPidFile=$run/slurmd.pid
SlurmctldLogFile=$run/slurmctld.log
SlurmdLogFile=$run/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
MpiDefault=none
PlugStackConfig=/dev/null
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
  export SLURM_CONF=$run/slurm.conf
  until_true 10 "munge" munge --socket="$run/munge/socket" --no-input || return 1
  slurmctld -D -i -f "$SLURM_CONF" 2>"$run/slurmctld.errors" &
  slurm_pids+=($!)
  until_true 20 "slurmctld" scontrol ping || { tail "$run"/slurmctld.*; return 1; }
  slurmd -D -f "$SLURM_CONF" 2>"$run/slurmd.errors" &
  slurm_pids+=($!)
  until_true 20 "slurmd" sh -c 'sinfo --noheader --states=idle | grep -q idle' || { tail "$run"/slurmd.*; return 1; }
}
