#include "reactions.H"
#include "models.H"
#include "SquareMatrix.H"

namespace
{

const char* const phase = "chemistry";

// Most passes of the correction of elements; each leaves the square of what it found.
const Foam::label mostPasses = 8;
// Pivot, of a matrix with a unit diagonal, below which a row is a combination of earlier ones.
const Foam::scalar dependent = 1e-13;
// What an element may be off by at the end, as a share of the total mass.
const Foam::scalar kept = 1e-15;

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
    chemistry_ = BasicChemistryModel<psiReactionThermo>::New(*thermo_);
    basicSpecieMixture& mixture = thermo_->composition();
    forAll(species, k)
    {
        own_[k] = mixture.species()[species[k]];
        // A checkpoint keeps the gas' own fractions.
        mixture.Y(own_[k]).writeOpt() = IOobject::NO_WRITE;
    }
    firstStep_ = chemistry_->get<scalar>("initialChemicalTimeStep");
    mixing_ = chemistry_->lookupOrDefault<scalar>("mixingConstant", -1);
    elements_ = List<scalarList>(chemistry_->lookup("elementShares"));
}


void Foam::calcine::reactions::evaluate
(
    scalar span,
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
    // The result must not depend on what the model did before.
    T_.mesh().lookupObjectRef<volScalarField::Internal>(named("deltaTChem")) =
        dimensionedScalar("firstStep", dimTime, firstStep_);
    chemistry_->solve(span);

    const scalarField density(thermo_->rho()().primitiveField());
    const scalarField share(mixing_ < 0 ? scalarField() : reactingShare(turbulence));
    // OpenFOAM's integration keeps the elements to some 1e-8 of what reacts.
    scalarList before(Y.size()), after(Y.size());
    forAll(density, celli)
    {
        forAll(Y, k)
        {
            before[k] = thermo_->composition().Y(own_[k])[celli];
            after[k] = before[k] + span*chemistry_->RR(own_[k])[celli]/density[celli];
        }
        restoreElements(before, after);
        forAll(Y, k)
        {
            rates_[k][celli] =
                (share.size() ? share[celli] : 1)*(after[k] - before[k])/span;
        }
    }
}


void Foam::calcine::reactions::restoreElements
(
    const scalarList& like,
    scalarList& fractions
) const
{
    for (scalar& y : fractions)
    {
        y = max(y, scalar(0));
    }
    const label count = elements_.size();
    scalar left = GREAT;
    for (label pass = 0; pass < mostPasses; ++pass)
    {
        scalarList lack(count, Zero);
        scalar worst = 0;
        forAll(elements_, e)
        {
            forAll(fractions, k)
            {
                lack[e] += elements_[e][k]*(like[k] - fractions[k]);
            }
            worst = max(worst, mag(lack[e]));
        }
        if (worst <= kept || worst >= left)
        {
            return;
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
