// Text dumps in LAMMPS' format, for OVITO and for all scripts that read LAMMPS.
//
// atoms.dump          dump custom: id type x y z radius vx .. omegax .. compressive_force
// pairs.dump          dump local:  id1 id2 fn ftx fty ftz overlap ..., forces on id1, fn > 0 repulsive
// wall_contacts.dump  dump custom, a particle a contact, at the contact point: id type x y z particle wall nx .. fn ftx ..
//                     (dump local without id type x y z where the source has no contact points)
// walls.dump          dump local: wall x y z qw qx qy qz vx .. omegax .. fx .. tx ..
//
// SI units; a type is a material, 1 where there are none, and the number of the wall from 1 in wall_contacts.dump. Every
// number has as many digits as give the same bits when it is read, so that with map() the files are the same frames again.
#pragma once
#include <filesystem>
#include <memory>

#include "libjam/snapshot/export/export_formats.hpp"

namespace jam {

std::unique_ptr<SnapshotExporter> export_lammps(const RunInfo& info, const std::filesystem::path& folder);

}  // namespace jam
