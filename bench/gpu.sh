#!/bin/bash
# On a GPU host, from the archive that scripts/bundle makes: what device there is, what simple shaders take on it, what
# the passes of the GPU form take, scenes a second beside the CPU, whether results are right there, and the thesis's
# teapots. It is planned so that the first figure comes within 40 s, and lasts at most 9 minutes on a card. It goes on
# after a failure and says at the end what failed. It needs nothing but the archive.
#   bench/gpu.sh [FOLDER]                default: gpu_results; all that was printed or measured lies there afterwards
#   BIN_SCENES_GL=software bench/gpu.sh  on llvmpipe, without any limit of time
#   QUICK=1       small forms of all, as there is no GPU to measure
#   STEPS='a b'   only these: doctor binaries probe passes variants one_scene batch tests teapots
#   VARIANTS=FOLDER   in each of its folders, files that replace shaders of the archive: the passes are timed so, too;
#                     a form that a define chooses is a file that defines it
# To keep the rows: copy FOLDER/results/<device> into bench/results of a checkout, then bench/publish there. Small forms
# are in FOLDER/quick/<device>: to look at only.
set -u
bundle=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[[ -x $bundle/run ]] || { echo "gpu.sh: runs from the archive that scripts/bundle makes" >&2; exit 2; }
out=${1:-gpu_results}
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 3
quick=${QUICK:-}
chosen=" ${STEPS:-doctor binaries probe passes variants one_scene batch tests teapots} "
# Where llvmpipe is the device, its own threads cost more than they give on small dispatches.
export LP_NUM_THREADS=${LP_NUM_THREADS:-0}
# Programs are compiled once, and kept for a disassembler.
export XDG_CACHE_HOME=$out/cache
minutes=9
failed=()

# step NAME LIMIT COMMAND...: runs it into NAME.log and keeps its verdict. On a card it ends after LIMIT seconds: a
# rented card is paid by the minute. Without a card nothing is limited, as a busy machine may take any time.
step() {
  local name=$1 limit=$2 start=$SECONDS code=0
  shift 2
  if [[ ${unlimited-1} ]]; then  # empty on a card; unset while that is not known
    "$@" > "$out/$name.log" 2>&1 </dev/null || code=$?
  else
    (( limit < minutes * 60 - SECONDS )) || limit=$((minutes * 60 - SECONDS))
    (( limit > 0 )) || { failed+=("$name"); echo "FAILED  $name: no time left"; return; }
    # A shell of its own, as what is run may be a function of this file.
    # shellcheck disable=SC2016  # the inner shell expands it
    timeout "$limit" bash -c '"$@"' - "$@" > "$out/$name.log" 2>&1 </dev/null || code=$?
  fi
  if (( code == 0 )); then
    echo "ok      $name ($((SECONDS - start)) s, at $SECONDS)"
  else
    failed+=("$name")
    echo "FAILED  $name: exit $code$( ((code == 124)) && echo ", ran longer than $limit s"); end of $name.log:"
    tail -n 15 "$out/$name.log" | sed 's/^/        /'
  fi
}

is_chosen() { [[ $chosen == *" $1 "* ]]; }

# bench LOG LIMIT ARGUMENTS...: a benchmark; the full rows are for a GPU: llvmpipe needs hours for them.
bench() {
  local name=$1 limit=$2 results=$out/results
  [[ $small ]] && results=$out/quick
  shift 2
  step "$name" "$limit" "$bundle/run" bin_scenes_bench --results "$results" ${small:+--quick} "$@"
  grep -E '^[a-z_]+: ' "$out/$name.log" | cut -c1-300
}

# The code in a binary as the driver returned it: an ELF file somewhere in it, or none that a disassembler knows.
disassemble() {
  local file=$1 at
  at=$(LC_ALL=C grep -aboP -m1 '\x7fELF' "$file" | head -n1 | cut -d: -f1)
  [[ $at ]] || { echo "$(basename "$file"): no ELF file inside"; return; }
  tail -c +$((at + 1)) "$file" > "$file.cubin"
  nvdisasm "$file.cubin" > "$file.sass" 2>&1
  echo "$(basename "$file"): $(grep -c '/\*[0-9a-f]*\*/' "$file.sass") lines of code," \
    "$(grep -cE '\bLDL|\bSTL' "$file.sass") of local memory," \
    "highest register $(grep -oE '\bR[0-9]+\b' "$file.sass" | tr -d R | sort -n | tail -n1)"
}

binaries() {
  mkdir -p "$out/programs"
  cp "$XDG_CACHE_HOME"/bin_scenes/programs/* "$out/programs/" || return
  ls -l "$out/programs"
  command -v nvdisasm > /dev/null || { echo "no nvdisasm here: look at the binaries elsewhere"; return 0; }
  local file
  for file in "$out"/programs/*; do [[ $file == *.* ]] || disassemble "$file"; done
}

# variants ROWS...: the same pass times with other shader trees, each made of the archive's own with files replaced.
variants() {
  local folder tree
  for folder in "$VARIANTS"/*/; do
    tree=$out/shaders_$(basename "$folder")
    cp -r "$shaders" "$tree" && cp -r "$folder". "$tree/" || return
    BIN_SCENES_SHADERS=$tree "$bundle/run" bin_scenes_bench --out "$out/variant_$(basename "$folder")" ${small:+--quick} \
      --filter passes --rows "$@" || return
  done
}

# Accepted scenes a second of a batch that is stopped after a while: those that were written count.
batch() {
  local seconds=$1 scenes=$2 parts=$3 start folder=$out/batch
  start=$(date +%s.%N)
  timeout -s INT "$seconds" "$bundle/run" bin_scenes generate "$bundle/config/conrods.yaml" --out "$folder" --overwrite \
    --scenes "$scenes" --set solver.sphere.device=gpu --set "parts[0].count=$parts" --formats json
  # 124: stopped, as was meant; 1: some scenes are set apart.
  local code=$? wall
  wall=$(awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { print b - a }')
  (( code == 0 || code == 1 || code == 124 )) || return "$code"
  local accepted
  accepted=$(find "$folder" -name scene.json -exec grep -l '"accepted": *true' {} + | wc -l)
  awk -v n="$accepted" -v s="$wall" 'BEGIN { printf "%d accepted in %.1f s: %.3f a second\n", n, s, n / s }'
}

# The tests of the layers named, side by side: what they find does not depend on how long they take.
tests() {
  local name start=$SECONDS limit=$1
  shift
  mkdir -p "$out/tests"
  # shellcheck disable=SC2016  # the inner shell expands them
  (cd "$bundle/tests" && find "$@" -type f | sort) |
    xargs -P "$(( $(nproc) < 16 ? $(nproc) : 16 ))" -I{} bash -c '
      log=$2/$(basename {}).log
      ${3:+timeout "$3"} "$1/run" tests/{} > "$log" 2>&1 </dev/null; echo $? > "${log%.log}.code"
    ' - "$bundle" "$out/tests" "${limited:+$limit}"
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

# 0 s. What the device is; programs are compiled for the first time.
step doctor 60 "$bundle/run" bin_scenes doctor
cat "$out/doctor.log"
software=$(grep -qiE 'llvmpipe|softpipe|swrast' "$out/doctor.log" && echo 1)
unlimited=$software limited=$([[ $software ]] || echo 1) small=$quick$software
shaders=${BIN_SCENES_SHADERS:-$bundle/shaders}
export out bundle shaders small
export -f binaries disassemble variants batch
# What is compared between shader trees; a small form has one size of groups.
compared=('phase=settle' 'worlds=264' 'world_group=64' 'pair_group=32') usual=('world_group=256' 'pair_group=32')
teapots=(--seconds 6)
[[ $small ]] && compared=('phase=settle' 'worlds=2') usual=() teapots=(--seconds 0.5 --set 'parts[0].count=16')

# The first figure: one phase of one world.
bench first_figure 30 --filter passes --rows phase=settle worlds=1 ${usual[@]+"${usual[@]}"}
is_chosen binaries && step binaries 20 binaries && cat "$out/binaries.log"

# 40 s. Which of L2, residency and instruction fetch limits what.
is_chosen probe && bench probe 40 --filter probe

# 75 s. Group sizes, settle and press, on worlds that differ.
if is_chosen passes; then
  if [[ $small ]]; then
    bench passes 1 --filter passes --rows 'phase=press'
  else
    for group in 64 256 128; do
      bench "passes_$group" 65 --filter passes --rows 'phase=[sp][er]e*' "world_group=$group" 'pair_group=32' 'worlds=[!1]*'
    done
    bench passes_pair_64 30 --filter passes --rows 'phase=settle' 'world_group=64' 'pair_group=64' 'worlds=264'
  fi
fi

# 260 s. Other forms of the same passes.
if is_chosen variants && [[ ${VARIANTS:-} ]]; then
  step variants 70 variants "${compared[@]}"
  grep -E '^passes: ' "$out/variants.log" | cut -c1-300
fi

# 330 s. One scene alone; then a batch, stopped after a minute.
is_chosen one_scene && bench one_scene 40 --filter throughput --rows solver=sphere/gpu scenes=1
if is_chosen batch; then
  if [[ $small ]]; then step batch 1 batch 100000 2 12; else step batch 80 batch 60 1024 256; fi
  tail -n 1 "$out/batch.log"
fi

# 420 s. Whether results are right on this device.
is_chosen tests && tests 80 gl solver generate

# 500 s. The thesis's 512 teapots, 600 steps stage by stage. Exit code 1: they are set apart, as they overlap, which is
# a property of that method.
# shellcheck disable=SC2016  # the inner shell expands them
is_chosen teapots && step teapots 40 bash -c '"$@" || (( $? == 1 ))' - \
  "$bundle/run" bin_scenes generate "$bundle/config/thesis_teapots.yaml" --out "$out/teapots" --overwrite --verbose \
  --set solver.thesis.iterations=5 "${teapots[@]}"

if (( ${#failed[@]} )); then
  echo "failed: ${failed[*]}" | tee "$out/failed.txt"
  exit 1
fi
echo "all passed in $SECONDS s; everything is in $out"
