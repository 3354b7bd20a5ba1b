# Sourced by the scripts. `arguments OPTIONS MOST ARGUMENT...` answers --help with the comment on top of the script, and
# refuses options that are not among OPTIONS and more than MOST other arguments. `missing WHAT COMMAND` ends a script
# that needs WHAT, which COMMAND installs.
arguments() {
  local options=" $1 " most=$2 name=${0##*/} argument
  shift 2
  for argument in "$@"; do
    case $argument in
      -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit ;;
      -*) [[ "$options" == *" $argument "* ]] ||
        { echo "$name: $argument: no such option (scripts/$name --help)" >&2 && exit 2; } ;;
      *) [[ $((most--)) -gt 0 ]] || { echo "$name: found \"$argument\" (scripts/$name --help)" >&2 && exit 2; } ;;
    esac
  done
}
missing() { echo "${0##*/}: $1 is missing: \`$2\` installs it" >&2 && exit 5; }
