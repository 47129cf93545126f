// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/luminaire.h"

namespace exitance {

Vec3 Luminaire::to_photometric(const Vec3& direction) const {
    return {dot(direction, c0), dot(direction, cross(c0, nadir)), -dot(direction, nadir)};
}

Vec3 Luminaire::to_world(const Vec3& direction) const {
    return c0 * direction.x + cross(c0, nadir) * direction.y - nadir * direction.z;
}

double Luminaire::intensity(const Vec3& direction) const {
    return multiplier * photometry->intensity(to_photometric(direction));
}

double Luminaire::flux() const {
    return multiplier * photometry->flux();
}

}  // namespace exitance
