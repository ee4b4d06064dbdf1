#!/bin/bash
# On a GPU host, from the archive that scripts/bundle makes: what device there is, whether shaders and solvers are right
# on it, and what it is worth: the tables of bin_scenes_bench, the thesis's teapots, the throughput of a batch. Takes less
# than 8 minutes, goes on after a failure and says at the end what failed. Needs nothing but the archive.
#   bench/gpu.sh [FOLDER]                default: gpu_results; all that was printed or measured lies there afterwards
#   BIN_SCENES_GL=software bench/gpu.sh  on llvmpipe; QUICK=1 for small forms of all, as there is no GPU to measure
# To keep the rows: copy FOLDER/results/<device> into bench/results of a checkout, then bench/publish there. Small forms
# lie in FOLDER/quick/<device>: to look at only.
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
  local name start=$SECONDS limit=150
  [[ ${BIN_SCENES_GL:-} == software ]] && limit=300  # s, of one
  mkdir -p "$out/tests"
  # shellcheck disable=SC2016  # the inner shell expands them
  (cd "$bundle/tests" && find "$@" -type f | sort) |
    xargs -P "$(( $(nproc) < 16 ? $(nproc) : 16 ))" -I{} bash -c '
      log=$2/$(basename {}).log; timeout "$3" "$1/run" tests/{} > "$log" 2>&1 </dev/null; echo $? > "${log%.log}.code"
    ' - "$bundle" "$out/tests" "$limit"
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

{
  uname -srm
  echo "cores: $(nproc)"
  nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null || echo "no nvidia-smi here"
} | tee "$out/host.txt"

step doctor 150 "$bundle/run" bin_scenes doctor  # compiles what it needs for its measurement
cat "$out/doctor.log"

# Shaders and solvers first: what builds on them means nothing if they are wrong.
tests gl solver generate

# The full rows are for a GPU: llvmpipe needs hours for them.
software=$(grep -qiE 'llvmpipe|softpipe|swrast' "$out/doctor.log" && echo 1)
small=$quick$software
bench() {  # NAME LIMIT ARGUMENTS...
  local name=$1 limit=$2 results=$out/results
  [[ $small ]] && results=$out/quick
  shift 2
  step "bench_$name" "$limit" "$bundle/run" bin_scenes_bench --results "$results" ${small:+--quick} "$@"
}

# Where the time goes: each pass, of one world and of many. Then one scene alone.
bench passes 90 --filter passes
bench one_scene 60 --filter throughput --rows solver=sphere/gpu scenes=1

# Small forms of what needs little: closed forms, and the least iterations at which the thesis's cubes stand.
small=1 bench closed_forms 60 --filter closed_forms
small=1 bench stability 30 --filter thesis_tables --rows table=stability

# The thesis's 512 teapots, 600 steps stage by stage, then its other tables. Exit code 1: they are set apart, as they
# overlap, which is that method's way.
# shellcheck disable=SC2016  # the inner shell expands them
step teapots 90 bash -c '"$@" || (( $? == 1 ))' - \
  "$bundle/run" bin_scenes generate "$bundle/config/thesis_teapots.yaml" --out "$out/teapots" --overwrite --seconds 6 --set solver.thesis.iterations=5 --verbose ${small:+--set "parts[0].count=16"}
for table in spheres_per_body static_spheres; do
  bench "$table" 40 --filter thesis_tables --rows "table=$table"
done

# One world of up to 65,536 parts, and up to 1024 worlds.
bench growth 100 --filter growth --rows solver=sphere/gpu

# The goals of the default solver on the device, by the report's own figures.
bench goals 120 --filter goals --rows solver=sphere/gpu

# The demo's scene with its pictures.
step conrods 60 "$bundle/run" bin_scenes generate "$bundle/config/conrods.yaml" --out "$out/conrods" --overwrite \
  --formats json,png ${small:+--set "parts[0].count=20"}

# Accepted scenes a second of 16 in one run, and of 512 in what time is left.
bench throughput 360 --filter throughput --rows solver=sphere/gpu

if (( ${#failed[@]} )); then
  echo "failed: ${failed[*]}" | tee "$out/failed.txt"
  exit 1
fi
echo "all passed in $SECONDS s; everything is in $out"
