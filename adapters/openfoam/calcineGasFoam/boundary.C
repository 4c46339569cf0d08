#include "boundary.H"

Foam::calcine::boundary::boundary
(
    const dictionary& patches,
    const volVectorField& velocity,
    const volScalarField& pressure
)
:
    mesh_(velocity.mesh()),
    driven_(patches.size()),
    passages_(mesh_.boundary().size(), passage::closed)
{
    label count = 0;
    for (const entry& item : patches)
    {
        driven_.set(count, new driven);
        driven& d = driven_[count++];
        d.patch = mesh_.boundaryMesh().findPatchID(item.keyword());
        if (d.patch < 0)
        {
            FatalIOErrorInFunction(patches)
                << "the mesh has no patch " << item.keyword() << "; it has "
                << mesh_.boundaryMesh().names() << exit(FatalIOError);
        }
        const dictionary& dict = item.dict();
        if (dict.found("superficialVelocity"))
        {
            d.superficialVelocity.reset(new schedule(dict, "superficialVelocity"));
        }
        if (dict.found("temperature"))
        {
            d.temperature.reset(new schedule(dict, "temperature"));
        }
    }

    bool open = false;
    forAll(passages_, patchi)
    {
        if (mesh_.boundary()[patchi].coupled())
        {
            FatalErrorInFunction
                << "the patch " << mesh_.boundary()[patchi].name()
                << " is coupled (" << mesh_.boundary()[patchi].type()
                << "), which this solver does not support" << exit(FatalError);
        }
        if (pressure.boundaryField()[patchi].fixesValue())
        {
            passages_[patchi] = passage::open;
            open = true;
        }
        else if (velocity.boundaryField()[patchi].fixesValue())
        {
            passages_[patchi] = passage::given;
        }
    }
    if (!open)
    {
        FatalErrorInFunction
            << "no patch has a fixed pressure in 0/p: the gas has no outlet" << exit(FatalError);
    }
}


void Foam::calcine::boundary::update
(
    scalar time,
    const scalarField& voidFraction,
    volVectorField& velocity,
    volScalarField& temperature
) const
{
    for (const driven& d : driven_)
    {
        const fvPatch& patch = mesh_.boundary()[d.patch];
        if (d.superficialVelocity.valid())
        {
            const scalar speed = d.superficialVelocity->at(time);
            const scalarField pores(voidFraction, patch.faceCells());
            velocity.boundaryFieldRef()[d.patch] == -speed/pores*patch.nf();
        }
        if (d.temperature.valid())
        {
            temperature.boundaryFieldRef()[d.patch] == d.temperature->at(time);
        }
    }
}
