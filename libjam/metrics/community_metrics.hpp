// Shape of the communities (libjam/graph/communities.hpp).
//
//   gap_factor    mean over the communities c of g_c = 1 - r_c s_c / s_max (Bassett et al., Soft Matter 11, 2731, 2015), s_c particles, s_max
//                 those of the largest; r_c is Pearson's correlation, over all pairs of particles of c, of their distance in contacts
//                 inside c and in space. Near 0 for one compact block, near 1 for branching ones that enclose gaps. Communities in which one of
//                 the two distances does not vary have no r_c and are left out
//   hull_ratio    mean over the communities of the volume of the convex hull of the centres over that of the particles (Huang and
//                 Daniels, Granul. Matter 18, 85, 2016). Communities of fewer than four, or in one plane, are left out
//
// NaN where no community is left.
#pragma once
#include "libjam/graph/communities.hpp"

namespace jam {

double gap_factor(const ContactGraph& graph, const Communities& communities);
double hull_ratio(const ContactGraph& graph, const Communities& communities);

}  // namespace jam
