// All numbers no farther than rad from mid.
#pragma once

namespace surfmesh {

struct Ball {
    double mid, rad;
};

}  // namespace surfmesh
