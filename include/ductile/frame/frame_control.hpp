// SPDX-License-Identifier: MIT
//
// One frame in as few parts as a tolerance needs.
//
// A part is done, judged by what it told, and put back and done again where it misplaced too much
// energy: ended where a flow stops, where a gap closes, or shorter.
//
//   error   = Σ R e + |work of rigid rows| + 0.3 |work of contacts|, + h/2 Σ R |u + u'|/2 where a
//             contact was lost in the part (e: part_row.hpp)                               [J]
//   scale   = plastic work so far of what is not idle + Σ ahead, ahead = R u²/(2 |a|) where a row
//             slows, R |u| h where it does not, + 0.05 R x travel that nobody misses       [J]
//             where a spring is beyond 0.3 of its strength no more than what flows would take,
//             + 10 x what springs hold, + 0.05 of the yield energy of the first one
//   stands where  error <= κ tolerance scale,  κ = 0.1
//
// Where nothing moves the scale is 0 and the part stands, whatever its length. Contacts that begin
// take energy that is real and does not shrink with the part, hence 0.3. In the shortest part it is
// a blow, no error, and so is what rigid rows take, once, of velocities that did not fit; what they
// give is one.
//
// Shorter: (1) to where a gap closed unforeseen; (2) to equal parts where a body that is pushed
// turned by more than 0.05 rad, or a joint farther than it can follow; (3) to where the row stopped
// that misplaced most, until one such part did not do: what stops there depends on others, so that
// the frame tries it no more; (4) by 0.85 √(allowed/error).
// Start: after a stop, a gap or a blow nothing is known of the forces, so a part of a thousandth of
// its length comes first, where more than what is allowed is at stake. Where a flow stops in that
// one too, and a tenth of the budget is gone, the next first one is as long as any next part.
// Next: longer by 0.85 ∛(allowed/error), as what a part misplaces is of third order, at most
// three times as long, in the same frame also after all flows have ended, not past the first
// stop that is predicted, u = -a t, nor past 0.045 rad of what is pushed; the last two parts of
// a frame share what is left of it. A frame at whose begin nothing is at stake is tried whole.
// Jump: an error that four tries and a tenth of the length do not lessen by a third is not one of
// length, such as a kick from elsewhere. The first length is done, and said. Unless rigid rows take
// it as a frame begins, of velocities that hands gave since the last one: these are struck first,
// in the shortest part. Where rigid rows may take more by what the engine rounds than all that
// there is to be taken, and more so in shorter parts, every error is one. Kick: where the shortest
// part is off by its flows, as bodies were set in motion from elsewhere, its accelerations are not
// compared with what follows. Before a part: a contact that touches and closes gets a blow, at most
// three in one instant, and so does what was thrown; a gap that would close within the part ends
// it. What cannot have to be put back is not saved; where that proves wrong the part stands, and
// says so. Budget: parts that were put back count. From three quarters of it on what is allowed
// grows by 10^(8 (used - 3/4)): a frame ends coarser and says so, as one last long part would be
// worse.
//
// Source: half-step composition as Strang (1968); error per step of the difference of accelerations
// as in Milne's device, Hairer, Norsett, Wanner, Solving ODEs I, section III.1. The rest is derived
// in README.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "ductile/frame/frame_report.hpp"
#include "ductile/frame/part_engine.hpp"
#include "ductile/vocabulary/check.hpp"

namespace ductile {

struct FrameParameters {
    double tolerance = 0.01; ///< of the plastic work [-], > 0
    int budget = 256;        ///< solves of a frame, >= 4

    /// @throws std::invalid_argument where one is out of range; `owner` is named.
    void validate(const char* owner = "FrameParameters") const;
};

/// Not thread-safe.
class FrameControl {
  public:
    /// @throws std::invalid_argument where a parameter is out of range.
    explicit FrameControl(const FrameParameters& parameters = {});

    /// One frame of `length` > 0 [s].
    /// @throws std::invalid_argument where the length is not finite or not positive, before
    /// anything was done; what the engine throws.
    const FrameReport& frame(PartEngine& engine, double length);
    /// One in which nothing is awake, and nothing is solved.
    void sleep();

    [[nodiscard]] const FrameParameters& parameters() const noexcept { return parameters_; }
    [[nodiscard]] const FrameReport& last() const noexcept { return report_; }
    [[nodiscard]] const RunReport& run() const noexcept { return run_; }

    /// Of the last frame: in so many parts that stand was a joint unreliable, each counted by
    /// itself.
    void count_unreliable(std::size_t joints) noexcept {
        report_.unreliable += joints;
        run_.unreliable += joints;
    }

    /// RunReport::brought_in so far; no number: nothing is known [J].
    void tell_contacts(double brought_in) noexcept { run_.brought_in = brought_in; }

    /// Somebody changed the bodies: what the last parts say of the next one is forgotten.
    void forget() noexcept;

  private:
    /// A part, judged [J].
    struct Judgement {
        double error = 0;
        double given = 0;     ///< of it: by dampers
        double astray = 0;    ///< of it: by breaks
        double of_rows = 0;   ///< of that, by flows
        double most = 0;      ///< that those can have taken: R x speed x length
        double allowed = 0;   ///< that grows as the budget goes
        double tolerated = 0; ///< that does not
        double least = 0;     ///< strength x travel that nobody misses, of all rows
        double of_one = 0;    ///< the largest of these
        double struck = 0;    ///< of velocities that rigid rows do not allow, by these
        double closed = 0;    ///< where a gap closed that was not foreseen [s]; 0: none did
        double of_island = 1; ///< the least that one island may misplace, of what all may
        double stop = 0;      ///< where the row stopped that misplaced most [s]; 0: none did
        double turned = 0;   ///< of turns that were too far, in those that a part may have; 0: none
        double power = 0;    ///< of all rows at their strength [W]
        bool ended = false;  ///< a flow ended in it
        bool moves = false;  ///< something was to be judged
        bool fitted = false; ///< rigid rows made velocities fit, without an error
    };
    struct Tally;
    /// What is known of a row from the part before.
    struct Past {
        PartRow row;
        double acceleration = 0; ///< a₋ [m/s² | rad/s²]
        double mass = 0;         ///< that it moves as a spring, as last told
        bool driven = false;     ///< by more than its own force, so far
        bool fast = false;       ///< it swings faster than a frame's parts can follow
    };

    /// Of a row in a frame in which a driven body's motion began, and after it.
    struct Kicked {
        bool rests = true;                   ///< as the frame began
        double speed = 0;                    ///< the fastest in that frame [m/s | rad/s]
        double peak = 0, time = 0, work = 0; ///< since then [m/s | rad/s], [s], [J]
        double doubted = 0;                  ///< of that [J]
        bool misread = false;                ///< the motion went on; until the row rests
    };

    /// How a part is done again.
    struct Shorter {
        double length; ///< [s]
        bool at_event; ///< a flow stops or a gap closes there
    };

    [[nodiscard]] double tolerated_share() const noexcept;
    [[nodiscard]] double used() const noexcept { return double(solves_) / parameters_.budget; }
    [[nodiscard]] bool spent() const noexcept { return solves_ + 1 >= parameters_.budget; }
    [[nodiscard]] PartBefore before(std::size_t row, const PartMotion& motion) const noexcept;
    [[nodiscard]] bool flowed(std::size_t row, const PartMotion& motion) const noexcept;
    [[nodiscard]] bool breaks(std::size_t row, const PartMotion& motion) const noexcept;
    [[nodiscard]] bool is_noise(const PartEngine& engine, const Judgement& judged) const;
    [[nodiscard]] double first_length(double left) noexcept;
    [[nodiscard]] double first_stop(double h) const noexcept;
    [[nodiscard]] double followed(double h) const noexcept;
    [[nodiscard]] bool at_stake(double h) const noexcept;
    [[nodiscard]] Judgement judge(const PartMotion& motion, double h, double shortest) const;
    void judge_islands(const PartMotion& motion, double h, Judgement& judged) const;
    [[nodiscard]] static Shorter shorter(const Judgement& judged, const PartMotion& motion,
                                         double h, bool may_stop);
    [[nodiscard]] double strike(PartEngine& engine, double h);
    void remember(const PartMotion& motion, double h);
    void forget_accelerations() noexcept;
    void begin_kicks(bool misread);
    void doubt_kicks(const PartMotion& motion, double h);
    [[nodiscard]] double attempt(PartEngine& engine, double h, double gap, double left);
    void stand(PartEngine& engine, const PartMotion& motion, const Judgement& judged, double h,
               bool at_event, bool jump);
    void say_unresolved(const PartMotion& motion, double error, double h);

    FrameParameters parameters_;
    FrameReport report_;
    RunReport run_;
    std::vector<Past> past_;
    std::vector<Kicked> kicked_;
    double before_ = 0;        ///< h₋ [s]
    bool starts_ = false;      ///< the part is a first short one
    bool stop_failed_ = false; ///< in this frame
    bool fresh_ = false;       ///< accelerations of the last part say nothing of the next
    bool fitted_ = false;      ///< the last part made velocities fit
    double start_ = 0;         ///< least length of a first short part [s]
    double next_ = 0;          ///< length of the next part [s]; 0: as long as may be
    double spin_ = 0;          ///< of what was pushed in the last part [rad/s]
    double allowed_ = 0;       ///< of the last part, in any island [J]
    double work_ = 0;          ///< plastic, of all joints [J]
    double last_work_ = 0;     ///< of the last frame [J]
    double taken_ = 0;         ///< by them beside their flow [J]
    double length_ = 0;        ///< of this frame [s]
    int solves_ = 0;           ///< the same
};

} // namespace ductile

#ifndef DUCTILE_COMPILED
#include "ductile/frame/frame_control.ipp"
#endif
