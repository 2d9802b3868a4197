# Checks by programs of others and studies: what scripts/test runs reduced, and scripts/study whole. To be sourced.

# A line each: what it shows, the script, its option for the reduced form.
checks=(
    "Colours against colour-science|validate-colour|--quick"
    "Tables in every container, by readers of others|validate-containers|"
    "Look-ups in WGSL, GLSL and HLSL against golden vectors|validate-shaders|--quick"
    "Solver against Monte Carlo|study-solver|--quick"
    "Water against PythonicDISORT|validate-water|--quick"
    "Thick air against PythonicDISORT|validate-air|--quick"
    "Skies against published measurements|validate-published|--quick"
    "JSON Schema of presets against their reader|validate-schema|"
    "Tables for three-atmosphere against that package in Chromium|validate-three-atmosphere|--quick"
)

python=.venv/bin/python
program=${CARGO_TARGET_DIR:-target}/release/tyndall

heading() { printf '\n== %s ==\n' "$1"; }

# The list that was installed is kept beside the packages: without a change to it, nothing is fetched.
install_python_packages() {
    heading "Python packages (.venv)"
    if ! "$python" -c '' 2>/dev/null || ! cmp -s scripts/requirements.txt .venv/installed.txt; then
        python3 -m venv --clear .venv
        "$python" -m pip install --quiet --disable-pip-version-check --retries 10 --timeout 60 \
            --requirement scripts/requirements.txt
        cp scripts/requirements.txt .venv/installed.txt
    fi
    "$python" -c 'import colour, numpy; print("colour-science", colour.__version__, "numpy", numpy.__version__)' 2>/dev/null
}

# run_checks quick|whole [SCRIPT...]: runs the checks (those of these scripts) two at a time, prints each whole, with
# its seconds, and adds what failed to `broken`.
run_checks() {
    local form=$1 logs title script quick code seconds
    shift
    logs=$(mktemp -d)
    for check in "${checks[@]}"; do
        IFS='|' read -r title script quick <<<"$check"
        [ $# -eq 0 ] || [[ " $* " == *" $script "* ]] || continue
        while [ "$(jobs -rp | wc -l)" -ge 2 ]; do wait -n || true; done
        [ "$form" = quick ] || quick=
        run_check "$logs/$script" "$script" $quick &
    done
    wait
    for check in "${checks[@]}"; do
        IFS='|' read -r title script quick <<<"$check"
        [ -e "$logs/$script.end" ] || continue
        read -r code seconds <"$logs/$script.end"
        heading "$title: scripts/$script, $seconds s"
        cat "$logs/$script"
        [ "$code" -eq 0 ] || broken+=("scripts/$script")
    done
    rm -rf -- "$logs"
}

run_check() {
    local log=$1 script=$2 begin=$SECONDS code=0
    shift 2
    "$python" "scripts/$script" "$program" "$@" >"$log" 2>&1 || code=$?
    echo "$code $((SECONDS - begin))" >"$log.end"
}
