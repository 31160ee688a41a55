#!/bin/bash
# Runs a program that is stopped most of the time, so that little computing fills a job's limit; what it computes is the
# same. Usage: slow.sh AWAKE ASLEEP PROGRAM WORD...     (seconds)
awake=$1 asleep=$2
shift 2
"$@" &
run=$!
told=
trap 'told=yes; kill -USR1 $run' USR1
while kill -0 $run; do
  kill -STOP $run
  sleep "$asleep"
  kill -CONT $run
  sleep "$awake"
done 2>/dev/null &
wait $run
code=$?
while [[ $told ]]; do
  told=
  wait $run
  code=$?
done
exit $code
