# Sourced by the other scripts: makes .venv with Strutwork in it. Needs $root, the checkout.

say() { printf '%s\n' "$*" >&2; }

# Debian packages $2... because $1 is missing. At a terminal the reader is asked; else root installs
# them, as a build does, but sudo is used only where STRUTWORK_INSTALL=yes says so.
debian_install() {
    missing=$1
    shift
    if ! command -v apt-get >/dev/null 2>&1; then
        say "$missing is missing, and there is no apt-get here to install it."
        say "Install the equivalent of the Debian packages: $*"
        exit 1
    fi
    if [ "$(id -u)" -eq 0 ]; then
        as_root='env'
    elif command -v sudo >/dev/null 2>&1; then
        as_root='sudo'
    else
        not_installed "$missing is missing, and installing it takes root rights." "$@"
    fi
    if [ "${STRUTWORK_INSTALL:-}" = yes ]; then
        :
    elif [ "${STRUTWORK_INSTALL:-}" = no ]; then
        not_installed "$missing is missing, and STRUTWORK_INSTALL=no." "$@"
    elif [ -t 0 ] && [ -t 2 ]; then
        say "$missing is missing. It comes with the Debian packages: $*"
        if [ "$as_root" = sudo ]; then how=' with sudo'; else how=''; fi
        printf 'Install them%s? [y/N] ' "$how" >&2
        read -r answer || answer=''
        case $answer in
            [yY] | [yY][eE][sS]) ;;
            *) not_installed "Nothing was installed." "$@" ;;
        esac
    elif [ "$as_root" = sudo ]; then
        not_installed "$missing is missing, and without a terminal to ask at, sudo is not used." "$@"
    fi
    say "Installing $missing (Debian packages: $*) ..."
    $as_root apt-get update -qq >/dev/null
    $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# End with the reason $1 and what to run for the Debian packages $2...
not_installed() {
    say "$1 Run this as root, then try again:"
    shift
    say "    apt-get update && apt-get install -y $*"
    say "STRUTWORK_INSTALL=yes lets this script do it, with sudo where you are not root."
    exit 1
}

# A Python of version 3.11 or newer: $PYTHON when set, else the first found.
find_python() {
    for candidate in ${PYTHON:+"$PYTHON"} python3 python3.14 python3.13 python3.12 python3.11; do
        if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            command -v "$candidate"
            return
        fi
    done
    say "No Python 3.11 or newer was found (tried python3 and python3.11 to python3.14)."
    say "Install one, or name it: PYTHON=/path/to/python sh $0"
    return 1
}

# What SfePy's C sources and the virtual environment need beside the interpreter.
need_build_tools() {
    base=$1
    version=$("$base" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    if ! "$base" -c 'import ensurepip, venv' 2>/dev/null; then
        debian_install "the venv module of Python $version" "python$version-venv"
    fi
    headers=$("$base" -c 'import sysconfig; print(sysconfig.get_path("include"))')
    if [ ! -f "$headers/Python.h" ]; then
        debian_install "the C headers of Python $version" "python$version-dev"
    fi
    if ! command -v cc >/dev/null 2>&1; then
        debian_install "a C compiler" gcc libc6-dev
    fi
}

# The environment with the extras $1 (may be empty); does nothing when that was done before.
ensure_environment() {
    extras=$1
    python="$root/.venv/bin/python"
    stamp="$root/.venv/installed${extras:+-$extras}"
    wanted="$root $(cksum <"$root/pyproject.toml")"
    if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ] && "$python" -c '' 2>/dev/null; then
        return
    fi
    if ! "$python" -m pip --version >/dev/null 2>&1; then
        base=$(find_python)
        need_build_tools "$base"
        say "Making a virtual environment in $root/.venv ..."
        "$base" -m venv --clear "$root/.venv"
    fi
    say "Installing Strutwork${extras:+ with what its tests need} (some minutes, only once) ..."
    log="$root/.venv/install.log"
    if ! "$python" -m pip install --quiet --disable-pip-version-check --prefer-binary \
        --editable "$root${extras:+[$extras]}" >"$log" 2>&1; then
        cat "$log" >&2
        say "The installation failed, for the reason above. Try again when it is mended."
        exit 1
    fi
    # what pip does for a wheel: a command that reads sources anew starts a quarter later
    (cd "$root" && "$python" -m compileall -q -x '^\./(\.|docs/|out/)' . >>"$log" 2>&1) || :
    # written last: an installation that was interrupted is taken up again
    printf '%s\n' "$wanted" >"$stamp"
    if [ -n "$extras" ]; then
        printf '%s\n' "$wanted" >"$root/.venv/installed"
    fi
}
