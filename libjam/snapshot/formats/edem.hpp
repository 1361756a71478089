// Text exports of EDEM (File > Export > Results Data, format "Text (.csv)"): answers to queries, a block for each time.
//
// What is known of the layout: EDEM's user guide ("Exporting Data", help.altair.com) has one answer a query, in a line or, with
// the option "Output Data in Columns", in a column, and a header that may be left out; names of queries are those of the
// tables for the P4 toolbox (github.com/particle-analytics/manual, post/post_edem.md): "Q02:Particle ID:", "Q11:Contact
// Normal Force X:". Read are, after whatever comes first,
//
//   TIME: 0.01                                     a cell that begins with TIME; the value in it or in the next one
//   Q02:Particle ID:,1,2,3                         one line a query
//   Q03:Particle Position X:,0.1,0.2,0.3
// or
//   TIME: 0.01
//   Q02:Particle ID:,Q03:Particle Position X:      one column a query
//   1,0.1
//
// The map gives columns by the query's name without its number and colons ("Particle ID"). Totals and other single
// answers are skipped. Contacts name particles by their ids, which EDEM exports only where the simulation recorded them
// (custom contact properties). Not compared with a file written by EDEM itself: we have none.
#pragma once
#include <vector>

#include "libjam/snapshot/formats/import_map.hpp"
#include "libjam/snapshot/formats/text_input.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

bool is_edem(const std::vector<InputHead>& inputs, const ImportMap* map);
// Needs a map. Frames are numbered, or counted in steps of the map's dt.
SnapshotSource open_edem(const std::vector<InputHead>& inputs, const ImportMap* map);

}  // namespace jam
