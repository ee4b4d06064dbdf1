#!/bin/bash
# On a GPU host, from the archive that scripts/bundle makes: what device there is, whether shaders and solvers are right
# on it, and how long the stages of the thesis's teapot scene take. Goes on after a failure and says at the end what
# failed. Needs nothing but the archive.
#   bench/gpu.sh [FOLDER]               default: gpu_results; all that was printed lies there afterwards
#   SECONDS_SIMULATED=2 bench/gpu.sh    a shorter teapot scene; 20 s are the thesis's 2000 steps
#   BIN_SCENES_GL=software bench/gpu.sh on llvmpipe
set -u
bundle=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[[ -x $bundle/run ]] || { echo "gpu.sh: runs from the archive that scripts/bundle makes" >&2; exit 2; }
out=${1:-gpu_results}
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 3
seconds=${SECONDS_SIMULATED:-20}
failed=()

# step NAME LIMIT COMMAND...: runs it into NAME.log and keeps its verdict.
step() {
  local name=$1 limit=$2 start=$SECONDS code=0
  shift 2
  timeout "$limit" "$@" > "$out/$name.log" 2>&1 </dev/null || code=$?
  if (( code == 0 )); then
    echo "ok      $name ($((SECONDS - start)) s)"
  else
    failed+=("$name")
    echo "FAILED  $name: exit $code$( ((code == 124)) && echo ", ran longer than $limit s"); end of $name.log:"
    tail -n 15 "$out/$name.log" | sed 's/^/        /'
  fi
}

# The last run's stage times: mean per step, from its scene.json.
stages() {
  local scene=$1
  [[ -f $scene ]] || return 0
  awk '/"steps":/ { gsub(/[^0-9]/, "", $2); steps = $2 }
       /"stages_ms": \{/ { inside = 1; next }
       inside && /\}/ { inside = 0 }
       inside { name = $1; ms = $2; gsub(/[":,]/, "", name); gsub(/,/, "", ms); total[name] = ms }
       END { for (name in total) printf "        %-24s %10.3f ms in all %10.4f ms/step\n", name, total[name], total[name] / (steps ? steps : 1) }' \
      "$scene" | sort
}

{
  uname -srm
  echo "cores: $(nproc)"
  nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null || echo "no nvidia-smi here"
} | tee "$out/host.txt"

step doctor 120 "$bundle/run" bin_scenes doctor
cat "$out/doctor.log"

# Shaders first: what builds on them means nothing if they are wrong.
for layer in gl solver sensor generate; do
  for test in $(find "$bundle/tests/$layer" -type f 2>/dev/null | sort); do
    step "$(basename "$test")" 600 "$bundle/run" "$test"
  done
done

# The thesis's tables: parts and iterations; the device's own time stamps go into scene.json.
for count in 256 512 1024; do
  for iterations in 10 5; do
    name=teapots_${count}_${iterations}
    step "$name" 1200 "$bundle/run" bin_scenes generate "$bundle/config/thesis_teapots.yaml" --out "$out/$name" \
      --seconds "$seconds" --formats json --set "parts[0].count=$count" --set "solver.thesis.iterations=$iterations"
    stages "$out/$name/scene_000000/scene.json"
  done
done

step conrods 600 "$bundle/run" bin_scenes generate "$bundle/config/conrods.yaml" --out "$out/conrods" --formats json,png

if (( ${#failed[@]} )); then
  echo "failed: ${failed[*]}" | tee "$out/failed.txt"
  exit 1
fi
echo "all passed; everything is in $out"
