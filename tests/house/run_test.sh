#!/bin/sh
# What ./run prints while it installs and builds, and what it asks for if it may not install. The programs that it calls
# are replaced by scripts.
#
#   run_test.sh RUN
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin" "$folder/checkout"
cp "$1" "$folder/checkout/run"
cd "$folder"

fail() {
    echo "run_test: $*" >&2
    exit 1
}

# pretend NAME: makes an executable NAME of standard input.
pretend() {
    { echo '#!/bin/sh'; cat; } >"bin/$1"
    chmod +x "bin/$1"
}

# The PATH holds only these programs of the system; sudo is not among them.
for program in sh dirname mktemp date tail tee grep cat rm tput printf env sed mkdir chmod; do
    ln -s "$(command -v "$program")" bin/
done

# run_as USER ARGUMENTS …: calls ./run on a terminal as this user; what it prints is in the file `said`.
run_as() {
    echo "echo $1" | pretend id
    shift
    script -qec "env PATH='$folder/bin' checkout/run $*" log </dev/null >said
}

# expect WORDS: fails unless the last call printed WORDS.
expect() {
    grep -qF -e "$1" said || { cat said; fail "expected it to say '$1'"; }
}

# Of all packages only g++ is installed.
pretend dpkg-query <<'end'
for package; do :; done
if [ "$package" = g++ ]; then echo "ii "; else exit 1; fi
end
pretend apt-get <<'end'
case $1 in
    update) echo update >>calls ;;
    install)
        echo "$@" >>calls
        echo 'Reading package lists...'
        echo 'dlstatus:1:2.5:Retrieving file 1 of 40'
        echo 'pmstatus:catch2:amd64:61.8:Unpacking catch2 (amd64)'
        [ ! -e broken ] || { printf 'E: no space left'; exit 100; }
        ;;
esac
end
pretend cmake <<'end'
case $1 in
    -S) mkdir -p checkout/build/release; echo >checkout/build/release/build.ninja ;;
    --build)
        echo '[7/284] Building CXX object CMakeFiles/deburr_bounds.dir/bounds/field.cpp.o'
        [ ! -e broken ] || { echo 'bounds/field.cpp:9:1: error'; exit 1; }
        printf '#!/bin/sh\necho "deburr was called: $*"\n' >checkout/build/release/deburr
        chmod +x checkout/build/release/deburr
        ;;
esac
end

# Neither root nor sudo: ./run prints the command that installs what is missing.
! run_as 1000 packages extra || fail "expected a failure without root"
expect "apt-get update && apt-get install -y --no-install-recommends cmake ninja-build "
expect " libembree-dev "
expect " fonts-dejavu-core extra"
[ ! -e calls ] || fail "expected no call of apt-get without root"

# sudo refuses: ./run prints the same command.
echo 'echo "sudo: you may not"; exit 1' | pretend sudo
! run_as 1000 packages || fail "expected a failure where sudo refuses"
expect "apt-get update && apt-get install -y --no-install-recommends cmake ninja-build "
[ ! -e calls ] || fail "expected no call of apt-get where sudo refuses"
rm bin/sudo

# As root it shows the progress of packages and of files, and then runs the program.
run_as 0 help mesh
expect "Installing: 2.5 % Retrieving file 1 of 40"
expect "Installing: 61.8 % Unpacking catch2 (amd64)"
expect "Building: 7/284 bounds/field.cpp"
expect "deburr was called: help mesh"
[ "$(head -n 1 calls)" = update ] || fail "expected the lists to be renewed first"

# The output of a command that fails is shown whole, without marks of progress.
touch broken
! run_as 0 packages || fail "expected a failure of apt-get to be one"
expect "E: no space left"
expect "run: apt-get install failed"
! grep -q pmstatus said || fail "expected no marks of progress"
pretend dpkg-query <<'end'
echo "ii "
end
! run_as 0 help || fail "expected a failure of the build to be one"
expect "bounds/field.cpp:9:1: error"
expect "run: building failed"
