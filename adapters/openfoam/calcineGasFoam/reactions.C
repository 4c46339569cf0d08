#include "reactions.H"

namespace
{

const char* const phase = "chemistry";

// Most passes of the correction of elements; each leaves the square of what it found.
const Foam::label mostPasses = 8;
// Pivot, of a matrix with a unit diagonal, below which a row is a combination of earlier ones.
const Foam::scalar dependent = 1e-13;
// Mixtures between a cell's gas and the one that would be there without reactions, at which rates are asked.
const Foam::label samples = 5;
// Error of a step in the temperature that counts as none, in K, as in Calcine's coordinator.
const Foam::scalar temperatureTolerance = 1e-3;
// What an element may be off by at the end, as a share of the total mass.
const Foam::scalar kept = 1e-15;
// More than that is no round-off.
const Foam::scalar roundOff = 100;

Foam::word named(const char* name)
{
    return Foam::IOobject::groupName(name, phase);
}

// A value after a time by implicit Euler without reactions.
Foam::scalar without(Foam::scalar start, Foam::scalar entering, Foam::scalar leaving, Foam::scalar time)
{
    return (start + time*entering)/(1 + leaving*time);
}

} // End anonymous namespace


bool Foam::calcine::reactions::wanted(const fvMesh& mesh)
{
    const fileName place(mesh.time().constant()/named("chemistryProperties"));
    return isFile(mesh.time().path()/place) || isFile(mesh.time().globalPath()/place);
}


Foam::calcine::reactions::reactions
(
    const fvMesh& mesh,
    const volScalarField& T,
    const gasMixture& mixture
)
:
    T_
    (
        IOobject(named("T"), mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimTemperature, Zero),
        "zeroGradient"
    ),
    mixture_(mixture),
    own_(mixture.names().size()),
    mixing_(-1),
    unknowns_(2*mixture.names().size() + 1)
{
    T_.primitiveFieldRef() = T.primitiveField();
    T_.correctBoundaryConditions();
    thermo_ = psiReactionThermo::New(mesh, phase);
    chemistry_.reset(new gasChemistry(*thermo_));
    basicSpecieMixture& known = thermo_->composition();
    forAll(own_, k)
    {
        own_[k] = known.species()[mixture.names()[k]];
        // A checkpoint keeps the gas' own fractions.
        known.Y(own_[k]).writeOpt() = IOobject::NO_WRITE;
    }
    cell_.reset(new stirredCell(*chemistry_, mixture_, own_));
    solver_ = ODESolver::New(*cell_, chemistry_->subDict("odeCoeffs"));
    solver_->absTol()[own_.size()] = temperatureTolerance;
    negligible_ = chemistry_->get<scalar>("negligible");
    mixing_ = chemistry_->lookupOrDefault<scalar>("mixingConstant", -1);
    elements_ = List<scalarList>(chemistry_->lookup("elementShares"));
}


bool Foam::calcine::reactions::reacts
(
    scalar p,
    scalar T,
    const scalarList& Y,
    const throughflow& flow,
    scalar time
) const
{
    const label count = Y.size();
    scalarList end(count), fractions(count);
    forAll(Y, k)
    {
        end[k] = max(without(Y[k], flow.entering[k], flow.leaving[k], time), scalar(0));
    }
    const scalar heat =
        without(mixture_.enthalpy(T, Y), flow.heatEntering, flow.heatLeaving, time);
    const scalar last = mixture_.temperature(heat, end, T);
    if (!(last > 0))
    {
        return true;
    }
    throughflow none;
    none.entering = scalarList(count, Zero);
    none.leaving = none.entering;
    cell_->set(none, p, time, 1);
    scalarField slope(unknowns_.size());
    for (label sample = 0; sample < samples; ++sample)
    {
        const scalar share = scalar(sample)/(samples - 1);
        forAll(Y, k)
        {
            unknowns_[k] = Y[k] + share*(end[k] - Y[k]);
        }
        unknowns_[count] = T + share*(last - T);
        cell_->derivatives(0, unknowns_, slope);
        forAll(Y, k)
        {
            if (mag(slope[k])*time > negligible_*(1 + flow.leaving[k]*time))
            {
                return true;
            }
        }
    }
    return false;
}


bool Foam::calcine::reactions::flowThrough
(
    scalar p,
    scalar T,
    const scalarList& Y,
    const throughflow& flow,
    scalar time,
    scalarList& made
) const
{
    made = Zero;
    if (!reacts(p, T, Y, flow, time))
    {
        return false;
    }
    const label count = Y.size();
    unknowns_ = Zero;
    forAll(Y, k)
    {
        unknowns_[k] = Y[k];
    }
    unknowns_[count] = T;
    cell_->set(flow, p, time, p*mixture_.compressibility(T, Y));
    // The result must not depend on what was integrated before: the whole window is tried first.
    scalar step = time;
    solver_->solve(0, time, unknowns_, step);
    forAll(Y, k)
    {
        made[k] = unknowns_[count + 1 + k];
        if (!(mag(made[k]) < GREAT))
        {
            FatalErrorInFunction
                << "the integration of reactions over " << time << " s from " << T << " K gave "
                << made[k] << " for what is made of " << mixture_.names()[k]
                << "; another solver may do: `odeCoeffs` of chemistryProperties" << exit(FatalError);
        }
    }
    keepPositive(Y, flow, time, made);
    return true;
}


void Foam::calcine::reactions::keepPositive
(
    const scalarList& Y,
    const throughflow& flow,
    scalar time,
    scalarList& made
) const
{
    // Of what is there without reactions, and what is made, times 1 + l t: elements are kept of these.
    scalarList inert(Y.size()), change(made);
    forAll(Y, k)
    {
        inert[k] = max(Y[k] + time*flow.entering[k], scalar(0));
        change[k] *= 1 + flow.leaving[k]*time;
    }
    limitMade(inert, change);
    forAll(Y, k)
    {
        made[k] = change[k]/(1 + flow.leaving[k]*time);
    }
}


void Foam::calcine::reactions::limitMade(const scalarList& inert, scalarList& made) const
{
    scalarList shares(inert), all(inert), wanted(elements_.size());
    scalar total = 0;
    forAll(inert, k)
    {
        all[k] += made[k];
        total += max(all[k], scalar(0));
    }
    forAll(inert, k)
    {
        shares[k] /= total;
    }
    elementsOf(shares, wanted);
    forAll(inert, k)
    {
        shares[k] = all[k]/total;
    }
    if (restoreElements(wanted, shares))
    {
        forAll(inert, k)
        {
            made[k] = shares[k]*total - inert[k];
        }
        return;
    }
    // Nothing that is there can give an element back: less of all is made.
    scalar share = 1;
    forAll(inert, k)
    {
        if (all[k] < 0)
        {
            share = min(share, -inert[k]/made[k]);
        }
    }
    for (scalar& one : made)
    {
        one *= share;
    }
}


void Foam::calcine::reactions::response
(
    scalar p,
    scalar T,
    const scalarList& Y,
    const throughflow& flow,
    scalar time,
    scalar start,
    scalar unit,
    scalarSquareMatrix& result
) const
{
    const label count = Y.size(), width = count + 1;
    forAll(Y, k)
    {
        unknowns_[k] = Y[k];
    }
    unknowns_[count] = T;
    cell_->set(flow, p, time, start);
    scalarField byTime(unknowns_.size());
    scalarSquareMatrix slopes(unknowns_.size());
    cell_->jacobian(0, unknowns_, byTime, slopes);

    // What reactions change, by fractions and enthalpy: T follows h = sum Y_k h_k(T).
    const scalar capacity = mixture_.heatCapacity(T, Y);
    scalarSquareMatrix factors(width, Zero);
    for (label k = 0; k < count; ++k)
    {
        const scalar byTemperature = time*slopes(width + k, count)/capacity;
        const scalar released = mixture_[k].formationEnthalpy()*(1 + flow.leaving[k]*time)
           /((1 + flow.heatLeaving*time)*unit);
        for (label j = 0; j < width; ++j)
        {
            const scalar change = j < count
              ? time*slopes(width + k, j) - byTemperature*mixture_[j].enthalpy(T)
              : byTemperature*unit;
            factors(k, j) -= change;
            factors(count, j) += released*change;
        }
        factors(k, k) += 1;
    }
    factors(count, count) += 1;
    labelList pivots(width);
    LUDecompose(factors, pivots);
    scalarField column(width);
    for (label j = 0; j < width; ++j)
    {
        column = Zero;
        column[j] = 1;
        LUBacksubstitute(factors, pivots, column);
        for (label i = 0; i < width; ++i)
        {
            result(i, j) = column[i];
        }
    }
}


void Foam::calcine::reactions::elementsOf
(
    const scalarList& fractions,
    scalarList& masses
) const
{
    forAll(elements_, e)
    {
        masses[e] = 0;
        forAll(fractions, k)
        {
            masses[e] += elements_[e][k]*fractions[k];
        }
    }
}


bool Foam::calcine::reactions::restoreElements
(
    const scalarList& masses,
    scalarList& fractions
) const
{
    for (scalar& y : fractions)
    {
        y = max(y, scalar(0));
    }
    const label count = elements_.size();
    scalar left = GREAT;
    scalarList lack(count);
    for (label pass = 0; pass < mostPasses; ++pass)
    {
        elementsOf(fractions, lack);
        scalar worst = 0;
        forAll(elements_, e)
        {
            lack[e] = masses[e] - lack[e];
            worst = max(worst, mag(lack[e]));
        }
        if (worst <= kept || worst >= left)
        {
            return worst <= roundOff*kept;
        }
        left = worst;
        // sum_f (sum_k Y_k a_ek a_fk) lambda_f = lack_e, by Cholesky's factors of the matrix scaled to a unit diagonal.
        SquareMatrix<scalar> factor(count, Zero);
        scalarList scale(count, Zero), solved(count, Zero), lambda(count, Zero);
        const auto entry = [&](label e, label f)
        {
            scalar sum = 0;
            forAll(fractions, k)
            {
                sum += elements_[e][k]*elements_[f][k]*fractions[k];
            }
            return sum;
        };
        for (label e = 0; e < count; ++e)
        {
            const scalar diagonal = entry(e, e);
            scale[e] = diagonal > 0 ? 1/sqrt(diagonal) : 0;
        }
        for (label e = 0; e < count; ++e)
        {
            for (label f = 0; f <= e && scale[e] > 0; ++f)
            {
                scalar rest = scale[e]*scale[f]*entry(e, f);
                for (label g = 0; g < f; ++g)
                {
                    rest -= factor(e, g)*factor(f, g);
                }
                if (f == e)
                {
                    factor(e, e) = rest > dependent ? sqrt(rest) : 0;
                }
                else if (factor(f, f) > 0)
                {
                    factor(e, f) = rest/factor(f, f);
                }
            }
            if (factor(e, e) > 0)
            {
                solved[e] = scale[e]*lack[e];
                for (label g = 0; g < e; ++g)
                {
                    solved[e] -= factor(e, g)*solved[g];
                }
                solved[e] /= factor(e, e);
            }
        }
        for (label e = count - 1; e >= 0; --e)
        {
            if (factor(e, e) > 0)
            {
                lambda[e] = solved[e];
                for (label g = e + 1; g < count; ++g)
                {
                    lambda[e] -= factor(g, e)*lambda[g];
                }
                lambda[e] /= factor(e, e);
            }
        }
        forAll(fractions, k)
        {
            scalar change = 1;
            forAll(elements_, e)
            {
                change += elements_[e][k]*scale[e]*lambda[e];
            }
            fractions[k] *= max(change, scalar(0));
        }
    }
    return left <= roundOff*kept;
}
