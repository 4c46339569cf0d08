#include "reactions.H"
#include "models.H"

namespace
{

const char* const phase = "chemistry";

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
    forAll(Y, k)
    {
        rates_[k] = chemistry_->RR(own_[k]).field()/density;
        if (share.size())
        {
            rates_[k] *= share;
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
