# Answers to help, --help and --version, sourced by ./gloam. They build, install and write nothing: a built program prints them,
# however old it is; otherwise they are read from the sources.

asks_for() {  # asks_for "WORD…" ARG…: whether an argument before -- is one of the words
  local words=" $1 " word
  shift
  for word in "$@"; do
    [ "$word" = -- ] && return 1
    [[ $words = *" $word "* ]] && return 0
  done
  return 1
}

# The strings of a C++ call in a source file, one call per line: NAME<tab>TEXT.
calls() {  # calls PATTERN FILE…
  local pattern=$1
  shift
  cat "$@" | tr '\n' ' ' | sed -E 's/" +"//g' | grep -oE "$pattern\([[:space:]]*\"[^\"]+\",[^;\"]*\"[^\"]*\"" \
    | sed -E 's/^[^"]*"([^"]*)",[^"]*"([^"]*)"$/\1\t\2/'
}

script_help() {
  printf '%s\n\n' "Gloam: a robotics simulator with unmodified MuJoCo physics and path-traced sensors."
  sed -n '2,/^set -/p' "$root/gloam" | sed -n 's/^# \{0,1\}//p'
  printf '\nCommands of the program:\n'
  calls "app\.add_subcommand" "$root"/apps/commands/*.cc | awk -F'\t' '{ printf "  %-12s %s\n", $1, $2 }'
  printf '\n%s\n' "The program is not built yet. After './gloam setup' (several minutes), './gloam COMMAND --help' lists every option."
}

command_help() {  # command_help COMMAND: of the program, as its source has it
  local file=$root/apps/commands/$1.cc
  [ -f "$file" ] || { script_help; return; }
  printf 'Usage: ./gloam %s [OPTION…] …\n\n' "$1"
  calls "app\.add_subcommand" "$file" | cut -f2
  printf '\n'
  calls 'add_(option|flag)' "$file" | awk -F'\t' '{ printf "  %-20s %s\n", $1, $2 }'
  printf '\n%s\n' "The program is not built yet. After './gloam setup', this help lists every option."
}

setup_help() {
  cat <<'END'
Usage: ./gloam setup [TARGET…]

Installs missing Debian packages, downloads the pinned wheels into .venv/ and builds into build/$GLOAM_PRESET (default:
build/release). Without TARGET it builds the program. All other commands of ./gloam run this setup first.

  GLOAM_PRESET=dev ./gloam setup    build with debug checks; presets: release, dev, asan, tsan, cuda, pack
  ./gloam setup gloam_python        build the Python module
END
}

python_help() {  # python_help FILE ARG…: the help of a tool in Python, else this script's
  PYTHONDONTWRITEBYTECODE=1 python3 "$@" --help 2>/dev/null || script_help
}

answer_help() {  # answer_help ARG…
  local program=$root/build/$preset/bin/gloam
  case "${1:-}" in
    setup) setup_help ;;
    test) python_help "$root/tests/run.py" ;;
    bench)
      case "${2:-}" in
        nav) python_help "$root/tools/navigation/commands.py" bench ;;
        real | slam) python_help "$root/tools/$2/commands.py" bench ;;
        *) python_help "$root/bench/run.py" ;;
      esac
      ;;
    real | slam) python_help "$root/tools/$1/commands.py" ${2:+"$2"} ;;
    match) if [ "${2:-}" = pick ]; then python_help "$root/tools/match/commands.py" pick; else python_help "$root/tools/match/commands.py"; fi ;;
    map | navigate) python_help "$root/tools/navigation/commands.py" "$1" ;;
    pack) python_help "$root/tools/pack.py" ;;
    wheel) python_help "$root/tools/wheel.py" ;;
    mitsuba) python_help "$root/bench/mitsuba/judge.py" ;;
    gallery) python_help "$root/tools/gallery/gallery.py" ;;
    docs) python_help "$root/tools/docs/docs.py" ;;
    doctor) python_help "$root/tools/doctor.py" ;;
    *)
      if [ -x "$program" ] && ! built_elsewhere "$root/build/$preset"; then
        cd "$here"
        exec "$program" "$@"
      fi
      if asks_for "--version" "$@"; then
        printf 'gloam %s (not built yet)\n' "$(sed -nE 's/^project\(gloam VERSION ([0-9.]+).*/\1/p' "$root/CMakeLists.txt")"
      else
        case "${1:-}" in -* | "") script_help ;; *) command_help "$1" ;; esac
      fi
      ;;
  esac
}

# --version is the program's own option: it stands before a command. The arguments of `python` are Python's.
asks_for_help() {  # asks_for_help ARG…
  [ "${1:-}" = --version ] && return 0
  [ "${1:-}" != python ] && asks_for "--help -h" "$@"
}
