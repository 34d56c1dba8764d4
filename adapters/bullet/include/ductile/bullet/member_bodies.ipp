// SPDX-License-Identifier: MIT
//
// Bodies of member.hpp: pieces, the joints between them, what is attached. A part of member.ipp.
#pragma once

#include <algorithm>

namespace ductile::bullet {

DUCTILE_INLINE void Member::become(const std::vector<PlacedPiece>& pieces, bool ahead) {
    if (pieces_.size() == 1) maker_->take_out();
    passing_.clear();
    std::vector<PieceBody> old = std::exchange(pieces_, {});
    const auto take_kept = [&old](const MemberRun& run) {
        for (PieceBody& piece : old) {
            if (piece.own != nullptr && piece.run == run) return std::move(piece);
        }
        return PieceBody{};
    };
    std::vector<const PlacedPiece*> made;
    for (const PlacedPiece& placed : pieces) {
        PieceBody piece = pieces.size() > 1 ? take_kept(placed.piece->run) : PieceBody{};
        piece.run = placed.piece->run;
        made.push_back(piece.body == nullptr ? &placed : nullptr);
        pieces_.push_back(std::move(piece));
    }
    // constraints end before their bodies
    std::erase_if(joints_, [this](const OpenSection& open) {
        const std::size_t lower = course_.piece_of(open.section);
        const bool stays = course_.section(open.section).open &&
                           pieces_[lower].body == &open.hinge->getRigidBodyB() &&
                           pieces_[lower + 1].body == &open.hinge->getRigidBodyA();
        return !stays;
    });
    for (Hold& hold : holds_) {
        if (piece_of(hold.at.segment).body != hold.body) hold.drop(*world_);
    }
    for (PieceBody& piece : old) {
        if (piece.own == nullptr) continue;
        MemberBook<Member>::all().leave(piece.body);
        world_->removeRigidBody(piece.body);
    }
    if (pieces.size() == 1) {
        pieces_[0].body = &user_;
        maker_->put_whole(pieces[0], course_.is_straight());
    } else {
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (made[i] == nullptr) continue;
            pieces_[i] = maker_->make(*made[i]);
            if (pieces_[i].own != nullptr) MemberBook<Member>::all().enter(pieces_[i].body, this);
        }
    }
    make_joints(ahead);
    make_attachments();
    let_pieces_pass();
}

/// Pieces that hang together do, and what holds on to one of them: Bullet lets pass what a
/// constraint itself joins. Those with a broken section between them meet.
DUCTILE_INLINE void Member::let_pieces_pass() {
    passing_.clear();
    broken_ = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        broken_ += i > 0 && course_.section(pieces_[i].run.first - 1).joint.broken;
        for (std::size_t j = i + 1; j < pieces_.size(); ++j) {
            if (course_.section(pieces_[j].run.first - 1).joint.broken) break;
            if (pieces_[i].own == nullptr) continue;
            passing_.add(*pieces_[i].body, *pieces_[j].body);
            for (const Hold& held : holds_) {
                if (!held.acts()) continue;
                const std::size_t at = course_.piece_of(held.at.segment);
                if (at == i) passing_.add(*pieces_[j].body, held.other());
                if (at == j) passing_.add(*pieces_[i].body, held.other());
            }
        }
    }
}
DUCTILE_INLINE void Member::see_open() {
    int broken = 0;
    for (const OpenSection& open : joints_) {
        const auto& joint = course_.section(open.section).joint;
        if (joint.flowing) open.hinge->keep_awake(); // slower than Bullet's threshold, too
        broken += joint.broken;
    }
    if (broken != broken_) let_pieces_pass();
}

DUCTILE_INLINE OpenSection Member::make_joint(std::size_t lower, const JointFrame<double>& in_lower,
                                              const JointFrame<double>& in_upper) {
    const int section = pieces_[lower].run.last;
    return {section, std::make_unique<btJointFeedback>(),
            std::make_unique<PlasticHinge<UsualAxisJoint>>(
                *pieces_[lower + 1].body, *pieces_[lower].body, to_bullet(in_upper),
                to_bullet(in_lower), description().section(section), Meeting::as_they_are)};
}
DUCTILE_INLINE void Member::enter_joint(OpenSection& open, bool ahead) {
    open.hinge->setJointFeedback(open.feedback.get());
    open.hinge->set_ahead(ahead);
    open.hinge->add_to(*world_, false); // who meets is passing_'s to say
    if (ahead) open.hinge->begin_part();
}

DUCTILE_INLINE void Member::make_attachments() {
    for (Hold& hold : holds_) {
        if (hold.constraint != nullptr) continue;
        const std::size_t piece = course_.piece_of(hold.at.segment);
        JointFrame<double> place = placed(course_.pieces()[piece].segment(hold.at.segment),
                                          {.origin = hold.at.in_segment});
        if (pieces_[piece].body == &user_) {
            place = placed(maker_->whole_in_body(), place);
        } else if (pieces_[piece].own == nullptr) {
            place = placed(held_, place);
        }
        hold.make("Member.attach", *world_, *pieces_[piece].body, to_bullet(place));
    }
}

} // namespace ductile::bullet
