#include "reactions.H"
#include "gasChemistry.H"
#include "models.H"
#include "ode.H"
#include "SquareMatrix.H"

namespace Foam
{

typedef ode<calcine::gasChemistry> odeOfGasChemistry;
defineTemplateTypeNameAndDebugWithName(odeOfGasChemistry, "ode<calcine>", 0);

} // End namespace Foam


namespace
{

const char* const phase = "chemistry";

// Most passes of the correction of elements; each leaves the square of what it found.
const Foam::label mostPasses = 8;
// Pivot, of a matrix with a unit diagonal, below which a row is a combination of earlier ones.
const Foam::scalar dependent = 1e-13;
// A span in s that OpenFOAM's chemistry takes for none.
const Foam::scalar nothing = 1e-3*Foam::SMALL;
// What an element may be off by at the end, as a share of the total mass.
const Foam::scalar kept = 1e-15;
// More than that is no round-off.
const Foam::scalar roundOff = 100;

Foam::word named(const char* name)
{
    return Foam::IOobject::groupName(name, phase);
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
    const wordList& species
)
:
    T_
    (
        IOobject(named("T"), mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimTemperature, Zero),
        "zeroGradient"
    ),
    own_(species.size()),
    mixing_(-1),
    rates_(species.size(), scalarField(mesh.nCells(), Zero))
{
    T_.primitiveFieldRef() = T.primitiveField();
    T_.correctBoundaryConditions();
    thermo_ = psiReactionThermo::New(mesh, phase);
    chemistry_.reset(new ode<gasChemistry>(*thermo_));
    basicSpecieMixture& mixture = thermo_->composition();
    forAll(species, k)
    {
        own_[k] = mixture.species()[species[k]];
        // A checkpoint keeps the gas' own fractions.
        mixture.Y(own_[k]).writeOpt() = IOobject::NO_WRITE;
    }
    negligible_ = chemistry_->get<scalar>("negligible");
    mixing_ = chemistry_->lookupOrDefault<scalar>("mixingConstant", -1);
    elements_ = List<scalarList>(chemistry_->lookup("elementShares"));
}


void Foam::calcine::reactions::evaluate
(
    const scalarField& span,
    const volScalarField& T,
    const PtrList<volScalarField>& Y,
    const models& turbulence
)
{
    T_.primitiveFieldRef() = T.primitiveField();
    T_.correctBoundaryConditions();
    // Iteration leaves fractions a little below zero.
    scalarField sum(T.size(), Zero);
    forAll(Y, k)
    {
        sum += max(Y[k].primitiveField(), scalar(0));
    }
    forAll(Y, k)
    {
        volScalarField& own = thermo_->composition().Y(own_[k]);
        own.primitiveFieldRef() = max(Y[k].primitiveField(), scalar(0))/sum;
        own.correctBoundaryConditions();
    }
    thermo_->he() = thermo_->he(thermo_->p(), T_);
    thermo_->correct();
    // The result must not depend on what the model did before: each integration tries the whole span first.
    T_.mesh().lookupObjectRef<volScalarField::Internal>(named("deltaTChem")).field() = span;
    chemistry_->calculate();
    chemistry_->solve(spans(span));

    const scalarField density(thermo_->rho()().primitiveField());
    const scalarField share(mixing_ < 0 ? scalarField() : reactingShare(turbulence));
    // OpenFOAM's integration keeps the elements to some 1e-8 of what reacts.
    scalarList before(Y.size()), after(Y.size()), masses(elements_.size());
    forAll(density, celli)
    {
        forAll(Y, k)
        {
            before[k] = thermo_->composition().Y(own_[k])[celli];
            after[k] = before[k] + span[celli]*chemistry_->RR(own_[k])[celli]/density[celli];
            if (!(mag(after[k]) < GREAT))
            {
                FatalErrorInFunction
                    << "the integration of reactions over " << span[celli] << " s from " << T_[celli] << " K gave "
                    << after[k] << " for the mass fraction of " << Y[k].name() << " at "
                    << T_.mesh().C()[celli] << " m; another solver may do: `odeCoeffs` of chemistryProperties"
                    << exit(FatalError);
            }
        }
        elementsOf(before, masses);
        restoreElements(masses, after);
        forAll(Y, k)
        {
            rates_[k][celli] =
                (share.size() ? share[celli] : 1)*(after[k] - before[k])/span[celli];
        }
    }
}


// The span that each cell is integrated over, by the rates of its start: none to speak of where nothing reacts, as natively.
Foam::scalarField Foam::calcine::reactions::spans(const scalarField& span) const
{
    const scalarField density(thermo_->rho()().primitiveField());
    scalarField fastest(density.size(), Zero);
    forAll(own_, k)
    {
        fastest = max(fastest, mag(chemistry_->RR(own_[k]).field()));
    }
    scalarField result(span);
    forAll(result, celli)
    {
        if (fastest[celli]*span[celli] <= negligible_*density[celli])
        {
            // OpenFOAM's model steps over what is below SMALL, and divides by it.
            result[celli] = nothing;
        }
    }
    return result;
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


Foam::scalarField Foam::calcine::reactions::reactingShare(const models& turbulence) const
{
    const scalarField chemical(chemistry_->tc()().primitiveField());
    const scalarField mixing
    (
        mixing_*turbulence.mixingTime(thermo_->mu()().primitiveField(), thermo_->rho()().primitiveField())
    );
    return chemical/(chemical + mixing);
}
