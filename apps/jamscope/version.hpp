#pragma once
namespace jamscope {

/// The program's version, `major.minor.patch`.
extern const char* const version;

/// Provenance: the commit that the program was built from, as `git describe --always --dirty --abbrev=12` names it, which every file that we
/// write carries; "unknown" where the source is no clone.
extern const char* const commit;

}  // namespace jamscope
