#include "speciesThermo.H"
#include "gradientEnergyFvPatchScalarField.H"
#include "mixedEnergyFvPatchScalarField.H"

namespace Foam
{
namespace calcine
{

defineTypeNameAndDebug(speciesThermo, 0);

} // End namespace calcine
} // End namespace Foam


bool Foam::calcine::speciesThermo::wanted(const fvMesh& mesh)
{
    const IOdictionary properties
    (
        IOobject
        (
            dictName, mesh.time().constant(), mesh, IOobject::MUST_READ, IOobject::NO_WRITE, false
        )
    );
    const entry* type = properties.findEntry("thermoType");
    return type && !type->isDict() && properties.get<word>("thermoType") == typeName;
}


Foam::calcine::speciesThermo::speciesThermo(const fvMesh& mesh)
:
    fluidThermo(mesh, word::null),
    mixture_(*this),
    Y_(mixture_.names().size()),
    h_
    (
        IOobject("h", mesh.time().timeName(), mesh),
        mesh,
        dimEnergy/dimMass,
        heBoundaryTypes(),
        heBoundaryBaseTypes()
    ),
    psi_
    (
        IOobject("thermo:psi", mesh.time().timeName(), mesh),
        mesh,
        dimensionSet(0, -2, 2, 0, 0)
    ),
    mu_
    (
        IOobject("thermo:mu", mesh.time().timeName(), mesh),
        mesh,
        dimensionSet(1, -1, -1, 0, 0)
    ),
    Cp_
    (
        IOobject("thermo:Cp", mesh.time().timeName(), mesh),
        mesh,
        dimEnergy/dimMass/dimTemperature
    ),
    here_(Y_.size())
{
    forAll(Y_, k)
    {
        Y_.set
        (
            k,
            new volScalarField
            (
                IOobject
                (
                    mixture_.names()[k], mesh.time().timeName(), mesh,
                    IOobject::MUST_READ, IOobject::NO_WRITE
                ),
                mesh
            )
        );
    }
    const tmp<volScalarField> start(he(p_, T_));
    h_.primitiveFieldRef() = start().primitiveField();
    forAll(h_.boundaryField(), patchi)
    {
        fvPatchScalarField& patch = h_.boundaryFieldRef()[patchi];
        patch == start().boundaryField()[patchi];
        if (isA<gradientEnergyFvPatchScalarField>(patch))
        {
            refCast<gradientEnergyFvPatchScalarField>(patch).gradient() =
                patch.fvPatchScalarField::snGrad();
        }
        else if (isA<mixedEnergyFvPatchScalarField>(patch))
        {
            refCast<mixedEnergyFvPatchScalarField>(patch).refGrad() =
                patch.fvPatchScalarField::snGrad();
        }
    }
    updateTransport();
}


const Foam::UList<Foam::scalar>& Foam::calcine::speciesThermo::cell(label celli) const
{
    forAll(Y_, k)
    {
        here_[k] = Y_[k][celli];
    }
    return here_;
}


const Foam::UList<Foam::scalar>& Foam::calcine::speciesThermo::face
(
    label patchi,
    label facei
) const
{
    forAll(Y_, k)
    {
        here_[k] = Y_[k].boundaryField()[patchi][facei];
    }
    return here_;
}


template<class Law>
Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::everywhere
(
    const word& name,
    const dimensionSet& dimensions,
    const volScalarField& T,
    const Law& law
) const
{
    auto result = tmp<volScalarField>::New
    (
        IOobject(name, T.mesh().time().timeName(), T.mesh(), IOobject::NO_READ, IOobject::NO_WRITE, false),
        T.mesh(),
        dimensionedScalar(dimensions, Zero)
    );
    forAll(T, celli)
    {
        result.ref()[celli] = law(T[celli], cell(celli));
    }
    forAll(T.boundaryField(), patchi)
    {
        result.ref().boundaryFieldRef()[patchi] ==
            onPatch(T.boundaryField()[patchi], patchi, law);
    }
    return result;
}


template<class Law>
Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::onPatch
(
    const scalarField& T,
    label patchi,
    const Law& law
) const
{
    auto result = tmp<scalarField>::New(T.size());
    forAll(T, facei)
    {
        result.ref()[facei] = law(T[facei], face(patchi, facei));
    }
    return result;
}


void Foam::calcine::speciesThermo::correct()
{
    forAll(T_, celli)
    {
        T_[celli] = mixture_.temperature(h_[celli], cell(celli), T_[celli]);
    }
    forAll(T_.boundaryField(), patchi)
    {
        fvPatchScalarField& T = T_.boundaryFieldRef()[patchi];
        fvPatchScalarField& h = h_.boundaryFieldRef()[patchi];
        forAll(T, facei)
        {
            const UList<scalar>& Y = face(patchi, facei);
            if (T.fixesValue())
            {
                h[facei] = mixture_.enthalpy(T[facei], Y);
            }
            else
            {
                T[facei] = mixture_.temperature(h[facei], Y, T[facei]);
            }
        }
    }
    updateTransport();
}


void Foam::calcine::speciesThermo::updateTransport()
{
    const auto set =
        [this](scalar T, const UList<scalar>& Y, scalar& psi, scalar& mu, scalar& Cp, scalar& alpha)
        {
            psi = mixture_.compressibility(T, Y);
            Cp = mixture_.heatCapacity(T, Y);
            scalar conductivity;
            mixture_.transport(T, Y, mu, conductivity);
            alpha = conductivity/Cp;
        };
    forAll(T_, i)
    {
        set(T_[i], cell(i), psi_[i], mu_[i], Cp_[i], alpha_[i]);
    }
    forAll(T_.boundaryField(), patchi)
    {
        const fvPatchScalarField& T = T_.boundaryField()[patchi];
        fvPatchScalarField& psi = psi_.boundaryFieldRef()[patchi];
        fvPatchScalarField& mu = mu_.boundaryFieldRef()[patchi];
        fvPatchScalarField& Cp = Cp_.boundaryFieldRef()[patchi];
        fvPatchScalarField& alpha = alpha_.boundaryFieldRef()[patchi];
        forAll(T, i)
        {
            set(T[i], face(patchi, i), psi[i], mu[i], Cp[i], alpha[i]);
        }
    }
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::he
(
    const volScalarField& p,
    const volScalarField& T
) const
{
    return everywhere
    (
        "h",
        dimEnergy/dimMass,
        T,
        [this](scalar t, const UList<scalar>& Y) { return mixture_.enthalpy(t, Y); }
    );
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::he
(
    const scalarField& p,
    const scalarField& T,
    const labelList& cells
) const
{
    auto result = tmp<scalarField>::New(T.size());
    forAll(T, i)
    {
        result.ref()[i] = mixture_.enthalpy(T[i], cell(cells[i]));
    }
    return result;
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::he
(
    const scalarField& p,
    const scalarField& T,
    const label patchi
) const
{
    return onPatch
    (
        T,
        patchi,
        [this](scalar t, const UList<scalar>& Y) { return mixture_.enthalpy(t, Y); }
    );
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::hc() const
{
    return everywhere
    (
        "hc", dimEnergy/dimMass, T_, [](scalar, const UList<scalar>&) { return scalar(0); }
    );
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::THE
(
    const scalarField& h,
    const scalarField& p,
    const scalarField& T0,
    const labelList& cells
) const
{
    auto result = tmp<scalarField>::New(h.size());
    forAll(h, i)
    {
        result.ref()[i] = mixture_.temperature(h[i], cell(cells[i]), T0[i]);
    }
    return result;
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::THE
(
    const scalarField& h,
    const scalarField& p,
    const scalarField& T0,
    const label patchi
) const
{
    auto result = tmp<scalarField>::New(h.size());
    forAll(h, i)
    {
        result.ref()[i] = mixture_.temperature(h[i], face(patchi, i), T0[i]);
    }
    return result;
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::Cp
(
    const scalarField& p,
    const scalarField& T,
    const label patchi
) const
{
    return onPatch
    (
        T,
        patchi,
        [this](scalar t, const UList<scalar>& Y) { return mixture_.heatCapacity(t, Y); }
    );
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::Cv() const
{
    return everywhere
    (
        "Cv",
        dimEnergy/dimMass/dimTemperature,
        T_,
        [this](scalar t, const UList<scalar>& Y)
        {
            // R/M = 1/(psi T).
            return mixture_.heatCapacity(t, Y) - 1/(t*mixture_.compressibility(t, Y));
        }
    );
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::Cv
(
    const scalarField& p,
    const scalarField& T,
    const label patchi
) const
{
    return onPatch
    (
        T,
        patchi,
        [this](scalar t, const UList<scalar>& Y)
        {
            return mixture_.heatCapacity(t, Y) - 1/(t*mixture_.compressibility(t, Y));
        }
    );
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::gamma() const
{
    return Cp_/Cv();
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::gamma
(
    const scalarField& p,
    const scalarField& T,
    const label patchi
) const
{
    return Cp(p, T, patchi)/Cv(p, T, patchi);
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::CpByCpv() const
{
    return everywhere
    (
        "CpByCpv", dimless, T_, [](scalar, const UList<scalar>&) { return scalar(1); }
    );
}


Foam::tmp<Foam::scalarField> Foam::calcine::speciesThermo::CpByCpv
(
    const scalarField& p,
    const scalarField& T,
    const label patchi
) const
{
    return tmp<scalarField>::New(T.size(), scalar(1));
}


Foam::tmp<Foam::volScalarField> Foam::calcine::speciesThermo::W() const
{
    return everywhere
    (
        "W",
        dimMass/dimMoles,
        T_,
        [this](scalar, const UList<scalar>& Y)
        {
            return 1e3*8.314462618*mixture_.compressibility(1, Y);
        }
    );
}
