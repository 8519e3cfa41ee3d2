#!/usr/bin/env bash
# Renders a scene in shards, several at a time, and merges them. The result is bit-identical to the single run.
#   render-parallel.sh SCENE SHARDS OUTPUT.exr [further options of `plumbline render`]
# PLUMBLINE  the command (default: plumbline)
# JOBS       shards at a time (default: one for each processor; each shard uses one thread)
# LAUNCHER   parallel (GNU parallel) or xargs (default: parallel where there is one, else xargs)
set -euo pipefail

if [ $# -lt 3 ]; then
  echo "usage: $0 SCENE SHARDS OUTPUT.exr [further options of \`plumbline render\`]" >&2
  exit 2
fi
scene=$1 shards=$2 output=$3
shift 3
if ! [[ $shards =~ ^[1-9][0-9]*$ ]]; then
  echo "$0: SHARDS: expected a number above 0, got $shards" >&2
  exit 2
fi
plumbline=${PLUMBLINE:-plumbline}
jobs=${JOBS:-$(nproc)}
if [ "$shards" -eq 1 ]; then  # is the whole image, and nothing to merge
  exec "$plumbline" render "$scene" -o "$output" "$@"
fi
launcher=${LAUNCHER:-}
if [ -z "$launcher" ]; then
  # moreutils has another program of that name
  if parallel --version 2>/dev/null | grep -q '^GNU parallel'; then launcher='parallel'; else launcher='xargs'; fi
fi
case $launcher in
  parallel) launch=(parallel --halt 'now,fail=1' --jobs "$jobs" --quote) ;;
  xargs) launch=(xargs -P "$jobs" -I '{}') ;;
  *)
    echo "$0: LAUNCHER: expected parallel or xargs, got $launcher" >&2
    exit 2
    ;;
esac

parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

# {} is the shard's number. Through cat, so that the shards see no terminal and draw no progress bars over each other.
seq 0 $((shards - 1)) |
  "${launch[@]}" "$plumbline" render "$scene" --shard "{}/$shards" --threads 1 -o "$parts/{}.exr" "$@" 2>&1 |
  cat >&2
"$plumbline" merge "$parts"/*.exr -o "$output"
