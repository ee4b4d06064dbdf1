#!/bin/bash
# On a GPU host, from the archive that scripts/bundle makes: what device there is, whether shaders and solvers are right
# on it, and what it is worth: the tables of bin_scenes_bench, the thesis's teapots, the throughput of a batch. Takes less
# than 8 minutes, goes on after a failure and says at the end what failed. Needs nothing but the archive.
#   bench/gpu.sh [FOLDER]                default: gpu_results; all that was printed or measured lies there afterwards
#   BIN_SCENES_GL=software bench/gpu.sh  on llvmpipe; QUICK=1 for small forms of all, as there is no GPU to measure
set -u
bundle=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[[ -x $bundle/run ]] || { echo "gpu.sh: runs from the archive that scripts/bundle makes" >&2; exit 2; }
out=${1:-gpu_results}
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 3
quick=${QUICK:-}
# Where llvmpipe is the device, its own threads cost more than they give on small dispatches.
export LP_NUM_THREADS=${LP_NUM_THREADS:-0}
minutes=8
failed=()

left() { echo $((minutes * 60 - SECONDS)); }

# step NAME LIMIT COMMAND...: runs it into NAME.log, for at most LIMIT seconds, and keeps its verdict.
step() {
  local name=$1 limit=$2 start=$SECONDS code=0
  shift 2
  (( limit < $(left) )) || limit=$(left)
  (( limit > 0 )) || { failed+=("$name"); echo "FAILED  $name: no time left"; return; }
  timeout "$limit" "$@" > "$out/$name.log" 2>&1 </dev/null || code=$?
  if (( code == 0 )); then
    echo "ok      $name ($((SECONDS - start)) s)"
  else
    failed+=("$name")
    echo "FAILED  $name: exit $code$( ((code == 124)) && echo ", ran longer than $limit s"); end of $name.log:"
    tail -n 15 "$out/$name.log" | sed 's/^/        /'
  fi
}

# The tests of the layers named, side by side: what they find does not depend on how long they take.
tests() {
  local name start=$SECONDS
  mkdir -p "$out/tests"
  (cd "$bundle/tests" && find "$@" -type f | sort) |
    xargs -P "$(( $(nproc) < 16 ? $(nproc) : 16 ))" -I{} bash -c '
      log=$2/$(basename {}).log; timeout 150 "$1/run" tests/{} > "$log" 2>&1 </dev/null; echo $? > "${log%.log}.code"
    ' - "$bundle" "$out/tests"
  for code in "$out"/tests/*.code; do
    name=$(basename "$code" .code)
    if [[ $(< "$code") == 0 ]]; then
      echo "ok      $name: $(grep -c '^\[       OK' "$out/tests/$name.log") tests"
    else
      failed+=("$name")
      echo "FAILED  $name: exit $(< "$code"); its log ends:"
      tail -n 15 "$out/tests/$name.log" | sed 's/^/        /'
    fi
    rm "$code"
  done
  echo "        all tests: $((SECONDS - start)) s"
}

# The time stamps of a scene.json: total and mean per step of each stage.
stages() {
  [[ -f $1 ]] || return 0
  awk '/"steps":/ { gsub(/[^0-9]/, "", $2); steps = $2 }
       /"stages_ms": \{/ { inside = 1; next }
       inside && /\}/ { inside = 0 }
       inside { name = $1; ms = $2; gsub(/[":,]/, "", name); gsub(/,/, "", ms); total[name] = ms }
       END { for (name in total) printf "        %-24s %10.3f ms in all %10.4f ms/step\n", name, total[name], total[name] / (steps ? steps : 1) }' \
      "$1" | sort
}

{
  uname -srm
  echo "cores: $(nproc)"
  nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null || echo "no nvidia-smi here"
} | tee "$out/host.txt"

step doctor 60 "$bundle/run" bin_scenes doctor
cat "$out/doctor.log"

# Shaders and solvers first: what builds on them means nothing if they are wrong.
tests gl solver sensor generate

# The thesis's 512 teapots, 200 of its 2000 steps, stage by stage.
for iterations in 10 5; do
  name=teapots_$iterations
  step "$name" 90 "$bundle/run" bin_scenes generate "$bundle/config/thesis_teapots.yaml" --out "$out/$name" --overwrite \
    --seconds "$([[ $quick ]] && echo 0.1 || echo 2)" --formats json --set "solver.thesis.iterations=$iterations" \
    ${quick:+--set "parts[0].count=64"}
  stages "$out/$name/scene_000000/scene.json"
done

# The demo's scene with its pictures, and many of them at once.
step conrods 120 "$bundle/run" bin_scenes generate "$bundle/config/conrods.yaml" --out "$out/conrods" --overwrite \
  --formats json,png ${quick:+--set "parts[0].count=20"}
scenes=$([[ $quick ]] && echo 2 || echo 64) parts=$([[ $quick ]] && echo 20 || echo 256)
start=$SECONDS
step batch 120 "$bundle/run" bin_scenes generate "$bundle/config/conrods.yaml" --out "$out/batch" --overwrite \
  --scenes "$scenes" --formats json --set "parts[0].count=$parts" --set "bin.inner_size=[0.5, 0.4, 0.3]"
accepted=$(grep -l '"accepted": true' "$out"/batch/scene_*/scene.json 2>/dev/null | wc -l)
echo "        $scenes scenes of $parts parts in $((SECONDS - start)) s, $accepted accepted"

# The tables: small forms of each, so that all fit. On a CPU that others use too, one may take longer.
table_limit=$([[ $quick ]] && echo 200 || echo 120)
for name in thesis_tables growth skipping closed_forms; do
  step "bench_$name" "$table_limit" "$bundle/run" bin_scenes_bench --quick --filter "$name" --out "$out/bench"
done

# One world of up to 65,536 parts, and up to 1024 worlds, on the device.
[[ $quick ]] || step bench_growth_gpu 150 "$bundle/run" bin_scenes_bench --filter growth --rows solver=sphere/gpu \
  --out "$out/bench_gpu"

if (( ${#failed[@]} )); then
  echo "failed: ${failed[*]}" | tee "$out/failed.txt"
  exit 1
fi
echo "all passed in $SECONDS s; everything is in $out"
