// Species, as mass fractions Y_k, with exactly the fluxes and masses of continuity, per cell:
//
//   (m Y - m_old Y_old)/dtau + sum phi_f Y_f - sum (eps mu)_f/Sc grad(Y).S = S - C Y + M
//
// with what particles give and take, whose sum continuity has, and what reactions make, M (chemistry.C).
//
// All species diffuse alike, so that Fick's fluxes sum to zero. Y_f as div(phi,Yi) of fvSchemes says, beyond
// upwind explicitly and with the smallest limiter of all species, so that the fractions go on summing to
// one; the last species is what the others leave.
//
// Enthalpy follows species: at a face it is that of the temperature and the fractions there, each limited on
// its own, and what diffuses carries its own enthalpy, so that gases that mix at one temperature stay there.
#include "gas.H"
#include "convection.H"
#include "speciesTransport.H"
#include "limitedSurfaceInterpolationScheme.H"
#include "fvm.H"
#include "fvc.H"

// The last species is what the others leave, their solvers' errors included. Where it differs by less than the tolerance it limits nobody.
void Foam::calcine::gas::limitNobodyByNoise(surfaceScalarField& limiter, const volScalarField& Y) const
{
    const surfaceScalarField difference(fvc::snGrad(Y)/mesh_.nonOrthDeltaCoeffs());
    const scalar noise = max(sqr(outer_.tolerance), VSMALL);
    const auto blend = [&](scalarField& values, const scalarField& differences)
    {
        forAll(values, i)
        {
            const scalar square = sqr(differences[i]), share = square/(square + noise);
            values[i] = values[i]*share + 2*(1 - share);
        }
    };
    blend(limiter.primitiveFieldRef(), difference.primitiveField());
    forAll(limiter.boundaryField(), patchi)
    {
        blend(limiter.boundaryFieldRef()[patchi], difference.boundaryField()[patchi]);
    }
}


Foam::tmp<Foam::surfaceScalarField> Foam::calcine::gas::speciesLimiter() const
{
    tmp<surfaceScalarField> least;
    for (const volScalarField& Y : species_->Y())
    {
        ITstream& scheme = mesh_.divScheme("div(phi,Yi)");
        const word kind(scheme);
        if (kind != "Gauss")
        {
            FatalErrorInFunction
                << "div(phi,Yi) of fvSchemes is of the kind " << kind
                << "; write `Gauss` and a limited scheme" << exit(FatalError);
        }
        tmp<surfaceScalarField> one
        (
            limitedSurfaceInterpolationScheme<scalar>::New(mesh_, phi_, scheme)().limiter(Y)
        );
        if (&Y == &species_->Y().last())
        {
            limitNobodyByNoise(one.ref(), Y);
        }
        least = least.valid() ? min(least, one) : one;
    }
    return least;
}


Foam::calcine::gas::speciesTransport::speciesTransport(const gas& of)
:
    diffusion("speciesDiffusion", of.speciesDiffusion()),
    limitedFlux(of.phi_*of.speciesLimiter()),
    inertia(of.committed_.mass/of.window_.storageSpan),
    kept(inertia - (of.outflow() - of.massSource())),
    beyond(of.species_->Y().size())
{
    const upwind<scalar> up(of.mesh_, of.phi_);
    forAll(beyond, k)
    {
        const volScalarField& Y = of.species_->Y()[k];
        beyond.set
        (
            k,
            new surfaceScalarField(limitedFlux*(fvc::interpolate(Y) - up.interpolate(Y)))
        );
        for (surfaceScalarField::Patch& patch : beyond[k].boundaryFieldRef())
        {
            if (!patch.coupled())
            {
                patch == Zero;
            }
        }
    }
}


Foam::tmp<Foam::fvScalarMatrix> Foam::calcine::gas::speciesEquation
(
    label k,
    const speciesTransport& transport,
    const fvScalarMatrix& laplacian
) const
{
    const volScalarField& Y = species_->Y()[k];
    const fv::gaussConvectionScheme<scalar> convection
    (
        mesh_, phi_, tmp<surfaceInterpolationScheme<scalar>>(new upwind<scalar>(mesh_, phi_))
    );
    tmp<fvScalarMatrix> equation(convection.fvmDiv(phi_, Y) - laplacian);
    fvScalarMatrix& matrix = equation.ref();
    inflow_.carry(matrix, phi_, k);
    matrix.diag() += transport.kept + given_.speciesCoefficient[k];
    matrix.source() += transport.inertia*committed_.composition[k]
      - outOf(transport.beyond[k]) + given_.speciesSource[k];
    return equation;
}


// As a share of what moves: through the boundary, from the particles, into storage; no closer than round-off of the terms.
Foam::scalar Foam::calcine::gas::speciesTarget(label k, const scalarField& diagonal) const
{
    const scalarField& Y = species_->Y()[k].primitiveField();
    scalar moving =
        gSumMag(mass_*Y - committed_.mass*committed_.composition[k])/window_.storageSpan
      + gSumMag(given_.speciesSource[k]);
    for (const fvsPatchScalarField& flux : phi_.boundaryField())
    {
        moving += flux.coupled() ? 0 : gSumMag(flux);
    }
    return max(linearTolerance_*moving, 1e-15*gSumMag(diagonal*Y));
}


Foam::scalar Foam::calcine::gas::solveSpecies(const speciesTransport& transport, report& result)
{
    PtrList<volScalarField>& Y = species_->Y();
    const label last = Y.size() - 1;
    const label internal = mesh_.nInternalFaces();

    scalar residual = 0;
    PtrList<surfaceScalarField> diffused(Y.size());
    speciesFlow_.setSize(Y.size());
    speciesFlow_[last] = SubField<scalar>(flux_, flux_.size() - internal, internal);
    for (label k = 0; k < last; ++k)
    {
        const fvScalarMatrix laplacian(fvm::laplacian(transport.diffusion, Y[k]));
        tmp<fvScalarMatrix> equation(speciesEquation(k, transport, laplacian));
        fvScalarMatrix& matrix = equation.ref();
        if (reactions_)
        {
            matrix.source() += speciesMade_[k];
        }

        const scalarField source(matrix.source());
        const solved solution =
            speciesSolver_->solve(matrix, source, speciesTarget(k, matrix.diag()), Y[k]);
        result.linearIterations += solution.iterations;
        residual = max(residual, solution.initial/gSumMag(matrix.diag()));

        diffused.set(k, (-laplacian.flux()).ptr());
        speciesFlow_[k].setSize(flux_.size() - internal);
        forAll(mesh_.boundary(), patchi)
        {
            const fvPatch& patch = mesh_.boundary()[patchi];
            forAll(patch, i)
            {
                const label facei = patch.start() + i - internal;
                const scalar flow =
                    matrix.internalCoeffs()[patchi][i]*Y[k][patch.faceCells()[i]]
                  - matrix.boundaryCoeffs()[patchi][i];
                speciesFlow_[k][facei] = flow;
                speciesFlow_[last][facei] -= flow;
            }
        }
    }

    Y[last].primitiveFieldRef() = 1;
    diffused.set
    (
        last, new surfaceScalarField(0*transport.diffusion*mesh_.magSf()*mesh_.deltaCoeffs())
    );
    for (label k = 0; k < last; ++k)
    {
        Y[last].primitiveFieldRef() -= Y[k].primitiveField();
        diffused[last] -= diffused[k];
    }
    Y[last].correctBoundaryConditions();
    carryEnthalpy(transport.limitedFlux, diffused);
    return residual;
}


void Foam::calcine::gas::carryEnthalpy
(
    const surfaceScalarField& limitedFlux,
    const PtrList<surfaceScalarField>& diffused
)
{
    const PtrList<volScalarField>& Y = species_->Y();
    const gasMixture& mixture = species_->mixture();
    const volScalarField& T = thermo_->T();
    const upwind<scalar> up(mesh_, phi_);
    ITstream& scheme = mesh_.divScheme("div(phi,h)");
    const word kind(scheme);
    const surfaceScalarField before(up.interpolate(T)), middle(fvc::interpolate(T));
    const surfaceScalarField limited
    (
        surfaceInterpolationScheme<scalar>::New(mesh_, phi_, scheme)().interpolate(T)
    );

    carried_.reset
    (
        new surfaceScalarField
        (
            IOobject("carried", mesh_.time().timeName(), mesh_),
            mesh_,
            dimensionedScalar(dimPower, Zero)
        )
    );
    const auto add =
        [&](label k, const auto& flow, const auto& flux, const auto& more, const auto& fraction,
            const auto& Tmiddle, const auto& Tbefore, const auto& Tlimited, auto& carried)
        {
            forAll(carried, i)
            {
                carried[i] += flow[i]*mixture[k].enthalpy(Tmiddle[i]);
                if (flux[i] != 0)
                {
                    carried[i] +=
                        (flux[i]*fraction[i] + more[i])*mixture[k].enthalpy(Tlimited[i])
                      - flux[i]*fraction[i]*mixture[k].enthalpy(Tbefore[i]);
                }
            }
        };
    forAll(Y, k)
    {
        const surfaceScalarField fraction(up.interpolate(Y[k]));
        const surfaceScalarField more(limitedFlux*(fvc::interpolate(Y[k]) - fraction));
        add
        (
            k, diffused[k], phi_, more, fraction, middle, before, limited,
            carried_->primitiveFieldRef()
        );
        forAll(T.boundaryField(), patchi)
        {
            // Convection at the boundary is upwind.
            const bool coupled = T.boundaryField()[patchi].coupled();
            const scalarField none(T.boundaryField()[patchi].size(), Zero);
            add
            (
                k,
                diffused[k].boundaryField()[patchi],
                coupled ? static_cast<const scalarField&>(phi_.boundaryField()[patchi]) : none,
                more.boundaryField()[patchi],
                fraction.boundaryField()[patchi],
                middle.boundaryField()[patchi],
                before.boundaryField()[patchi],
                limited.boundaryField()[patchi],
                carried_->boundaryFieldRef()[patchi]
            );
        }
    }

    // The iterate of the enthalpy is that of the temperature at hand and the new fractions.
    thermo_->he().primitiveFieldRef() = thermo_->he(modelPressure_, T)().primitiveField();
    thermo_->he().correctBoundaryConditions();
}


void Foam::calcine::gas::balanceSpecies(report& result) const
{
    result.species.clear();
    if (!species_)
    {
        return;
    }
    const PtrList<volScalarField>& Y = species_->Y();
    result.species.setSize(Y.size());
    forAll(Y, k)
    {
        balance& own = result.species[k];
        const scalarField stored
        (
            mass_*Y[k].primitiveField() - committed_.mass*committed_.composition[k]
        );
        own.stored = gSum(stored);
        own.storedMagnitude = gSumMag(stored);
        own.exchange = window_.storageSpan*gSum
        (
            given_.speciesSource[k] - given_.speciesCoefficient[k]*Y[k].primitiveField()
        );
        if (reactions_)
        {
            own.source = window_.storageSpan*gSum(speciesMade_[k]);
            own.sourceMagnitude = window_.storageSpan*gSumMag(speciesMade_[k]);
        }
        for (const fvPatch& patch : mesh_.boundary())
        {
            if (patch.coupled())
            {
                continue;
            }
            const label start = patch.start() - mesh_.nInternalFaces();
            const SubField<scalar> flow(speciesFlow_[k], patch.size(), start);
            own.boundary -= window_.storageSpan*gSum(flow);
            // All ranks are summed up together.
            result.patches[patch.index()][5 + k] -= sum(flow);
            own.boundaryMagnitude += window_.storageSpan*gSumMag(flow);
        }
    }
}
