#!/usr/bin/env bash
# What the measuring programs say to a slip of their user's: one line, exit code 2, and nothing is written. They are no
# part of a test's build (./dev bench builds them), so this skips itself where they are missing or older than a source.
# usage: run.sh FOLDER_OF_PROGRAMS
set -euo pipefail
source=$(dirname "$(readlink -f "$0")")/../..
programs=$(readlink -m "$1")
for program in depthgrid_bench floor_scale laser_accuracy laser_lost paper_accuracy metric_curves; do
  if [ ! -x "$programs/$program" ] ||
    [ -n "$(find "$source"/{bench,mapper} '(' -name '*.cc' -o -name '*.h' ')' -newer "$programs/$program" -print -quit)" ]
  then
    echo "skipped: no $program of these sources (./dev bench builds it)"
    exit 77
  fi
done
scratch=$(mktemp -d -t depthgrid-bench.XXXXXX)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
failed=0
fail() { echo "FAILED: $*"; cat out err 2>/dev/null || true; failed=1; }

# refused WORDS PROGRAM ARGUMENT...: exit code 2 and one line that holds the words.
refused() {
  local words=$1 code=0
  shift
  timeout 60 "$programs/$1" "${@:2}" >out 2>err || code=$?
  [ $code = 2 ] || fail "$*: exit code $code"
  [ "$(wc -l <err)" = 1 ] || fail "$*: not one line"
  grep -qF -- "$words" err || fail "$*: does not say '$words'"
}
# measured PROGRAM ARGUMENT...: exit code 0; what it says is in out.
measured() { timeout 60 "$programs/$1" "${@:2}" >out 2>err || fail "$*: exit code $?"; }
says() { grep -qF -- "$1" out || fail "does not say '$1'"; }
never_says() { ! grep -qF -- "$1" out || fail "says '$1'"; }
quick=(depthgrid_bench --filter 'least squares/160 beams' --repetitions 1 --min-time 0.001)

refused "contains 'nosuch'" depthgrid_bench --filter nosuch
refused "contains 'nosuch'" depthgrid_bench --filter nosuch --write-baseline --baseline none.json
[ ! -e none.json ] || fail 'a baseline of nothing'
refused 'with --long only' depthgrid_bench --filter 2400
refused 'no folder /nonexistent' "${quick[@]}" --write-baseline --baseline /nonexistent/x.json
refused 'no folder /nonexistent' "${quick[@]}" --json /nonexistent/x.json
refused 'missing.json' "${quick[@]}" --baseline missing.json
for value in 0 -3 1.5; do refused "--repetitions" depthgrid_bench --repetitions $value; done
for value in -1 nan 1e9; do refused '--min-time' depthgrid_bench --min-time $value; done
refused '--band' depthgrid_bench --band -1
refused '--no-such' depthgrid_bench --no-such

measured "${quick[@]}"
says 'No bench/baseline.json in this folder'
never_says 'by more than'
measured "${quick[@]}" --write-baseline --baseline mine.json --json times.json
says 'The baseline is in mine.json'
grep -q '"least squares"' mine.json || fail 'a baseline without its case'
grep -q '"real_time"' times.json || fail 'no times'
measured "${quick[@]}" --baseline mine.json
never_says 'ANOTHER'

# A baseline of a thousandth and of a thousand times its own ratio.
ratio=$(sed -n 's/.*"160 beams": //p' mine.json)
with_ratio() { sed "s/\"160 beams\": .*/\"160 beams\": $1/" mine.json >other.json; }
with_ratio "$(awk "BEGIN {print $ratio / 1000}")"
measured "${quick[@]}" --baseline other.json
grep -A1 '^Slower' out | grep -q 'least squares, 160 beams' || fail 'nothing is slower'
with_ratio "$(awk "BEGIN {print 1000 * $ratio}")"
measured "${quick[@]}" --baseline other.json
grep -A1 '^Faster' out | grep -q 'least squares, 160 beams' || fail 'nothing is faster'
measured "${quick[@]}" --baseline other.json --band 1 # -100 % is the least that the column can show
says 'Faster than the baseline by more than 100 %: nothing'
with_ratio 0
refused 'other.json: least squares, 160 beams: is 0' "${quick[@]}" --baseline other.json
echo '{"garbled' >other.json
refused 'other.json: is no baseline' "${quick[@]}" --baseline other.json
refused 'other.json: is no baseline' "${quick[@]}" --write-baseline --baseline other.json
[ "$(cat other.json)" = '{"garbled' ] || fail 'a file that is no baseline was overwritten'

sed 's/"cpu": .*/"cpu": "Abacus",/' mine.json >other.json
cp other.json abacus.json
measured "${quick[@]}" --baseline other.json
says 'ANOTHER MACHINE: Abacus'
refused 'is of another machine (Abacus' "${quick[@]}" --write-baseline --baseline other.json
cmp -s other.json abacus.json || fail 'ratios of two machines in one baseline'

refused '--floors' floor_scale --floors 0 --frames 10
refused '--floors' floor_scale --floors -5 --frames 10
refused '--floors' floor_scale --floors nan --frames 10
refused '--frames' floor_scale --floors 5 --frames 0
refused '--frames' floor_scale --floors 5 20 --frames 10
refused '--beams' floor_scale --beams 0
refused '--rate' floor_scale --rate -1
refused '--no-such' floor_scale --no-such
# Paced: 30 frames at 60 Hz take half a second.
begin=$(date +%s%N)
measured floor_scale --floors 5 --frames 31 --rate 60 --no-finish
took_ms=$((($(date +%s%N) - begin) / 1000000))
[ $took_ms -ge 500 ] || fail "31 frames at 60 Hz took $took_ms ms"

printf '0 0 6 0\n6 0 6 6\n6 6 0 6\n0 6 0 0\n' >w.world.txt
for k in 0 1 2 3 4 5 6 7 8 9; do echo "$k 2.$k 3 0 0 0 0 1"; done >w.truth.txt
refused '--seeds' laser_accuracy --worlds w --seeds 0
refused '--seeds' laser_accuracy --worlds w --seeds -1
refused '--threads' laser_accuracy --worlds w --threads 0
refused '--beams' laser_accuracy --worlds w --beams 1
refused '--worlds' laser_accuracy
refused '--lost-at' laser_lost --world w --lost-at 0 --back-at 5
refused '--lost-at' laser_lost --world w --lost-at 100 --back-at 5
refused '--back-at' laser_lost --world w --lost-at 5 --back-at 100
refused '--seeds' laser_lost --world w --lost-at 5 --back-at 5 --seeds 0
refused 'nowhere: is no folder' metric_curves nowhere
refused '--seeds' paper_accuracy --variant a --seeds 0
refused '--threads' paper_accuracy --variant a --threads 0
exit $failed
