// SPDX-License-Identifier: MIT
//
// What a joint of ODE's has for itself of ERP and CFM, in place of the world's, and what a part or
// a blow makes of it (frame/part_settings.hpp): its rows, of a ball, fixed, double-ball,
// double-hinge joint or transmission; its stops, where it has some; the suspension of a hinge-2.
// Left as they are, a stop that is overrun within a frame is pushed back in parts of microseconds,
// at any speed.
//
// Not thread-safe.
#pragma once

#include <ode/ode.h>

#include <span>
#include <vector>

#include "ductile/frame/part_settings.hpp"
#include "ductile/vocabulary/linkage.hpp"

namespace ductile::ode {

class OwnSettings {
  public:
    /// Rules the joints of these bodies for a part of `h` [s] in a frame of `frame` [s], or a blow.
    DUCTILE_INLINE void rule(std::span<const dBodyID> bodies, double h, double frame, bool blow);
    /// They are as they were.
    DUCTILE_INLINE void put_back();

  private:
    struct Own {
        dJointID joint;
        void (*set)(dJointID, int, dReal);
        int erp_name, cfm_name;
        Softness usual;
        bool spring; ///< a share of what the frame removes, not of each part
    };
    DUCTILE_INLINE void find(dJointID joint);

    std::vector<Own> own_;
};

} // namespace ductile::ode

#ifndef DUCTILE_COMPILED
#include "ductile/ode/own_settings.ipp"
#endif
