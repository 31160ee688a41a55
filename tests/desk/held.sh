#!/bin/bash
# Runs a program that is suspended as soon as it has written a checkpoint, until a signal stops it (USR1): a job is then
# stopped within its run on a machine of any speed, if the rest of the run takes seconds. Usage: held.sh CHECKPOINT
# PROGRAM WORD...
checkpoint=$1
shift
state() { stat --format='%i %y' "$checkpoint" 2>&1; }
before=$(state)
"$@" &
run=$!
signalled=
trap 'signalled=yes; kill -USR1 $run; kill -CONT $run' USR1
while kill -0 $run; do
  # The signal may come between the check and the suspension: the next pass resumes the program.
  if [[ $signalled ]]; then
    kill -CONT $run
  elif [[ $(state) != "$before" ]]; then
    kill -STOP $run
  fi
  sleep 0.02
done 2>/dev/null
wait $run
