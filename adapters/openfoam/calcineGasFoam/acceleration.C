#include "acceleration.H"
#include "PstreamReduceOps.H"
#include "SVD.H"

#include <algorithm>
#include <cmath>

namespace
{

using namespace Foam;

// Calls `put(place, value)` for every component of a flow.
template<class Put>
void each(const calcine::accelerated& flow, const Put& put)
{
    label place = 0;
    for (vectorField* vectors : {&flow.velocity, &flow.pressureGradient, &flow.pressureAlong})
    {
        for (vector& value : *vectors)
        {
            for (direction axis = 0; axis < 3; ++axis)
            {
                put(place++, value[axis]);
            }
        }
    }
    for (scalarField* scalars : {&flow.pressure, &flow.flux})
    {
        for (scalar& value : *scalars)
        {
            put(place++, value);
        }
    }
}

void gather(const calcine::accelerated& flow, scalarField& all)
{
    all.setSize
    (
        3*(flow.velocity.size() + flow.pressureGradient.size() + flow.pressureAlong.size())
      + flow.pressure.size() + flow.flux.size()
    );
    each(flow, [&all](label place, scalar& value) { all[place] = value; });
}

} // End anonymous namespace


void Foam::calcine::acceleration::begin
(
    const accelerated& flow,
    const scalarField& mass,
    const scalarField& push
)
{
    gather(flow, step_);
    if (!hasLast_)
    {
        momentumWeight_ = mass;
        pushWeight_ = mass*sqr(push);
    }
}


void Foam::calcine::acceleration::combine(const accelerated& flow, scalar share)
{
    gather(flow, after_);
    step_ = after_ - step_;
    if (hasLast_)
    {
        remember();
    }
    const scalarField factor(factors());
    const scalar left = 1 - share;
    each
    (
        flow,
        [&](label place, scalar& value)
        {
            value = after_[place] - left*step_[place];
            forAll(factor, j)
            {
                const change& one = changes_[j];
                value -= factor[j]*(scalar(one.after[place]) - left*scalar(one.step[place]));
            }
        }
    );
    lastAfter_.swap(after_);
    lastStep_.swap(step_);
    hasLast_ = true;
}


void Foam::calcine::acceleration::remember()
{
    if (label(changes_.size()) == depth)
    {
        std::rotate(changes_.begin(), changes_.begin() + 1, changes_.end());
        changes_.pop_back();
    }
    changes_.emplace_back();
    change& last = changes_.back();
    last.after.resize(after_.size());
    last.step.resize(step_.size());
    forAll(after_, i)
    {
        last.after[i] = float(after_[i] - lastAfter_[i]);
        last.step[i] = float(step_[i] - lastStep_[i]);
    }
}


template<class List>
Foam::scalar Foam::calcine::acceleration::product
(
    const List& one,
    const std::vector<float>& other
) const
{
    const label cells = momentumWeight_.size();
    scalar sum = 0;
    for (label i = 0; i < 3*cells; ++i)
    {
        sum += momentumWeight_[i/3]*one[i]*other[i];
        sum += pushWeight_[i/3]*one[3*cells + i]*other[3*cells + i];
    }
    return returnReduce(sum, sumOp<scalar>());
}


Foam::scalarField Foam::calcine::acceleration::factors() const
{
    const label count = label(changes_.size());
    scalarField found(count, Zero);
    if (count == 0)
    {
        return found;
    }
    scalarSquareMatrix normal(count, Zero);
    for (label i = 0; i < count; ++i)
    {
        for (label j = 0; j <= i; ++j)
        {
            normal(i, j) = normal(j, i) = product(changes_[i].step, changes_[j].step);
        }
    }
    scalarField scale(count, Zero), right(count, Zero);
    bool finite = true;
    forAll(scale, j)
    {
        scale[j] = normal(j, j) > 0 ? 1/Foam::sqrt(normal(j, j)) : 0;
        right[j] = scale[j]*product(step_, changes_[j].step);
        finite = finite && std::isfinite(right[j]);
    }
    for (label i = 0; i < count; ++i)
    {
        for (label j = 0; j < count; ++j)
        {
            normal(i, j) *= scale[i]*scale[j];
            finite = finite && std::isfinite(normal(i, j));
        }
    }
    if (!finite)
    {
        return found;
    }
    // Singular values below this share of the largest are left out.
    const scalar independent = 1e-10;
    const SVD solved(scalarRectangularMatrix(normal), independent);
    const scalarRectangularMatrix inverse(solved.VSinvUt());
    for (label i = 0; i < count; ++i)
    {
        for (label j = 0; j < count; ++j)
        {
            found[i] += scale[i]*inverse(i, j)*right[j];
        }
    }
    return found;
}
