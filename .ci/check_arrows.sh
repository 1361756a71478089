#!/usr/bin/env bash
# Fails, naming file and line, where a room includes one that it must not see.
#
#   .ci/check_arrows.sh [FOLDER]      FOLDER: the repository, default the one this script is in
#
# The table: room, then the rooms it may include (itself always). "lib/." are the files beside the rooms; errors.hpp is a
# leaf that every room of its library may include, all other files beside the rooms may include any room and no room may
# include them. A room that is missing here is an error, so that a new one gets its arrows.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

read -r -d '' arrows <<'TABLE' || true
libdem/case
libdem/particles    libdem/case
libdem/geometry     libdem/case libdem/particles
libdem/neighbors    libdem/case libdem/particles libdem/geometry
libdem/contact      libdem/case libdem/particles libdem/geometry libdem/neighbors
libdem/simulation   libdem/case libdem/particles libdem/geometry libdem/neighbors libdem/contact
libdem/bed          libdem/case libdem/particles libdem/geometry libdem/neighbors libdem/contact libdem/simulation
libdem/scene    libdem/case libdem/particles libdem/geometry libdem/neighbors libdem/contact libdem/simulation libdem/bed
libdem/.            libdem/case libdem/particles libdem/geometry libdem/neighbors libdem/contact libdem/simulation libdem/bed libdem/scene
libjam/snapshot
libjam/graph        libjam/snapshot
libjam/tessellation libjam/snapshot
libjam/jamming      libjam/snapshot libjam/graph
libjam/metrics      libjam/snapshot libjam/graph libjam/tessellation libjam/jamming
libjam/events       libjam/snapshot libjam/graph libjam/jamming
libjam/statistics   libjam/snapshot libjam/graph libjam/jamming libjam/events
libjam/.            libjam/snapshot libjam/graph libjam/tessellation libjam/jamming libjam/metrics libjam/events libjam/statistics
apps                libdem libjam
tests/support
tests/dem           libdem tests/support
tests/jam           libjam tests/support
tests/app           libdem libjam apps tests/support
tests/bench         libdem libjam apps tests/support tests/dem
TABLE

find libdem libjam apps tests -name node_modules -prune -o \( -name '*.hpp' -o -name '*.cpp' \) -print | sort |
  xargs grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' /dev/null |
  awk -v arrows="$arrows" '
    # The room of a path: lib/room, lib/. for files beside the rooms, apps, tests/part.
    function room(path,   part, n) {
      n = split(path, part, "/")
      if (part[1] == "libdem" || part[1] == "libjam") return part[1] "/" (n > 2 ? part[2] : ".")
      if (part[1] == "tests") return part[1] "/" (n > 2 ? part[2] : ".")
      return part[1]
    }
    BEGIN {
      lines = split(arrows, line, "\n")
      for (i = 1; i <= lines; ++i) {
        n = split(line[i], word, " ")
        known[word[1]] = 1
        for (k = 1; k <= n; ++k) allowed[word[1], word[k]] = 1
      }
      bad = 0
    }
    {
      match($0, /^[^:]+:[0-9]+:/)
      place = substr($0, 1, RLENGTH - 1)
      file = place; sub(/:[0-9]+$/, "", file)
      split($0, quoted, "\""); target = quoted[2]
      from = room(file); to = room(target)
      if (!(from in known)) { print place ": the room " from " is not in the table of .ci/check_arrows.sh"; ++bad; next }
      split(target, part, "/")
      if (part[1] !~ /^(libdem|libjam|apps|tests)$/) {
        print place ": \"" target "\" is not written from the root of the repository"; ++bad; next
      }
      if (from == to) next
      library = part[1]
      if (target == library "/errors.hpp" && index(from, library "/") == 1) next
      if ((from, to) in allowed || (from, library) in allowed) next
      print place ": " from " must not include " to " (\"" target "\")"; ++bad
    }
    END { if (bad) { print bad " forbidden include(s)"; exit 1 } }'
echo "arrows: fine"
