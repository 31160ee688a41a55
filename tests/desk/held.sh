#!/bin/bash
# Runs a program that is held as soon as it has written a checkpoint, until it is told to stop (USR1): a job is then
# stopped half-way on a machine of any speed, if the run takes seconds from there. Usage: held.sh CHECKPOINT PROGRAM WORD...
checkpoint=$1
shift
state() { stat --format='%i %y' "$checkpoint" 2>&1; }
before=$(state)
"$@" &
run=$!
told=
trap 'told=yes; kill -USR1 $run; kill -CONT $run' USR1
while kill -0 $run; do
  # Told between the question and the hold: the next round lets it go.
  if [[ $told ]]; then
    kill -CONT $run
  elif [[ $(state) != "$before" ]]; then
    kill -STOP $run
  fi
  sleep 0.02
done 2>/dev/null
wait $run
