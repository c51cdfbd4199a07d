// What speaks against an end of referencing, and what it is worth beside others.
#pragma once

#include <span>
#include <string>

#include "kernels/registration/judge_links.hpp"
#include "platform/reference/find_reference.hpp"

namespace glint {

// How much of the robot's surface the scene explains, hidden and unseen parts counted as not
// explained, times how well the scene ends where the robot does. 1 at most.
[[nodiscard]] double worth(const Candidate& candidate, const FindReferenceSettings& settings);

// Whether another end is nearly as good as the one found.
[[nodiscard]] bool rivals(const Candidate& other, const Candidate& found,
                          const FindReferenceSettings& settings);

// Why this is no pose to work with; empty: it is one.
[[nodiscard]] std::string objection(const Candidate& candidate,
                                    const FindReferenceSettings& settings);

// The same of single links: other joint values, or another robot, leave some unexplained.
[[nodiscard]] std::string link_objection(const LinkJudgement& links,
                                         const FindReferenceSettings& settings);

// The same of one of several pictures: each must agree with the pose of all.
[[nodiscard]] std::string picture_objection(const std::string& name, const Judgement& picture,
                                            const FindReferenceSettings& settings);

// An end that something speaks against is worth less than any other.
[[nodiscard]] bool better(const Candidate& a, const Candidate& b,
                          const FindReferenceSettings& settings);

}  // namespace glint
