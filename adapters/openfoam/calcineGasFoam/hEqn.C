// Enthalpy, with exactly the fluxes and masses of continuity, per cell:
//
//   (m h - m_old h_old)/dtau + sum phi_f h_f - sum (eps kappa)_f grad(T).S = S - K T(h) + eps V (p0 - p0_old)/dtau + H - sum_k D_k h_k(T) + Q
//
// h_f as fvSchemes says, beyond upwind explicitly; T linear in h: T = T* + (h - h*)/c_p. Because m = m_old - dtau sum phi_f, a uniform temperature
// stays uniform whatever the flow does (p0, the model's pressure, changes in a closed domain alone), and energy closes to the linear tolerance whatever the outer
// loop does. In the pores the gas conducts with eps kappa: its share of the cross-section.
#include "gas.H"
#include "convection.H"
#include "fvm.H"
#include "fvc.H"

void Foam::calcine::gas::assembleEnthalpy()
{
    const volScalarField& h = thermo_->he();
    const volScalarField& T = thermo_->T();
    const scalar span = window_.storageSpan;
    heatCapacity_ = thermo_->Cp()().primitiveField();
    temperatureBase_ = T.primitiveField() - h.primitiveField()/heatCapacity_;

    const scalar compression = (basePressure() - committed_.basePressure)/span;
    enthalpy_.reset();
    enthalpy_.reset
    (
        new fvScalarMatrix
        (
            convect(phi_, h, "div(phi,h)", share_, beyondH_)
        )
    );
    if (species_)
    {
        beyondH_.reset(new surfaceScalarField(*carried_));
    }
    fvScalarMatrix& matrix = *enthalpy_;
    addConduction(matrix);
    inflow_.carry(matrix, phi_, -1);
    updateGivenHeat();
    matrix.diag() +=
        committed_.mass/span + heatSlope_/heatCapacity_ - outflow() + massSource();
    matrix.source() += committed_.mass*committed_.enthalpy/span
      + heatGiven_ - heatSlope_*temperatureBase_
      - outOf(*beyondH_) + compression*given_.voidFraction*mesh_.cellVolumes();
    if (reactions_)
    {
        matrix.source() += heatMade_;
    }
    if (models_->radiates())
    {
        const scalarField pores(given_.voidFraction*mesh_.cellVolumes());
        models_->radiativeHeat(T.primitiveField(), radiationCoefficient_, radiationSource_);
        radiationCoefficient_ *= pores;
        radiationSource_ *= pores;
        matrix.diag() += radiationCoefficient_/heatCapacity_;
        matrix.source() += radiationSource_ - radiationCoefficient_*temperatureBase_;
    }
    boundary_.addHeat
    (
        window_.processEnd,
        conductivity()(),
        temperatureBase_,
        heatCapacity_,
        ownerDistance_,
        matrix
    );
}


Foam::scalar Foam::calcine::gas::solveEnthalpy(report& result)
{
    assembleEnthalpy();
    fvScalarMatrix& matrix = *enthalpy_;
    volScalarField& h = thermo_->he();
    const volScalarField& T = thermo_->T();
    const scalar span = window_.storageSpan;

    // The tolerance is a share of the energy that moves; no closer than round-off of the terms.
    const scalar content = gSumMag(matrix.diag()*heatCapacity_*T.primitiveField());
    const scalarField heat
    (
        heatGiven_ - heatSlope_*T.primitiveField()
    );
    scalar moving = sumMag(heat) + sumMag
    (
        mass_*(h.primitiveField() - referenceEnthalpy_)
      - committed_.mass*(committed_.enthalpy - referenceEnthalpy_)
    )/span;
    for (const fvPatch& patch : mesh_.boundary())
    {
        if (boundary_.of(patch.index()) == passage::within)
        {
            continue;
        }
        const fvsPatchScalarField& flux = phi_.boundaryField()[patch.index()];
        moving += sumMag(flux*(h.boundaryField()[patch.index()] - referenceEnthalpy_));
    }
    reduce(moving, sumOp<scalar>());
    const scalar target = max(linearTolerance_*moving, 1e-15*content);
    const solved solution =
        enthalpySolver_.solve(matrix, scalarField(matrix.source()), target, h);
    result.linearIterations += solution.iterations;
    return solution.initial/content;
}


// What particles take of the gas leaves with h_k(T), linear in T about that at hand.
void Foam::calcine::gas::updateGivenHeat()
{
    heatGiven_ = given_.heatSource;
    heatSlope_ = given_.heatCoefficient;
    if (given_.speciesSource.empty())
    {
        return;
    }
    const scalarField& T = thermo_->T().primitiveField();
    heatGiven_ += given_.speciesHeat;
    forAll(given_.speciesTaken, k)
    {
        const gasSpecies& one = species_->mixture()[k];
        const scalarField& taken = given_.speciesTaken[k];
        forAll(T, celli)
        {
            const scalar slope = one.heatCapacity(T[celli]);
            heatGiven_[celli] -= taken[celli]*(one.enthalpy(T[celli]) - slope*T[celli]);
            heatSlope_[celli] += taken[celli]*slope;
        }
    }
}


// Takes the conduction of T = base + h/c_p, each cell with its own base and c_p, from the equation.
void Foam::calcine::gas::addConduction(fvScalarMatrix& enthalpy) const
{
    const volScalarField& T = thermo_->T();
    surfaceScalarField conduction("conduction", fvc::interpolate(conductivity()));
    inflow_.seal(conduction);
    fvScalarMatrix heat(fvm::laplacian(conduction, T));
    if (heat.faceFluxCorrectionPtr())
    {
        enthalpy.faceFluxCorrectionPtr() = new surfaceScalarField(-*heat.faceFluxCorrectionPtr());
    }
    const labelUList& owner = mesh_.owner();
    const labelUList& neighbour = mesh_.neighbour();
    const scalarField& upper = heat.upper();
    scalarField& diagonal = enthalpy.diag();
    scalarField& source = enthalpy.source();

    diagonal -= heat.diag()/heatCapacity_;
    source -= heat.source() - heat.diag()*temperatureBase_;
    forAll(upper, facei)
    {
        const label P = owner[facei], N = neighbour[facei];
        enthalpy.upper()[facei] -= upper[facei]/heatCapacity_[N];
        enthalpy.lower()[facei] -= upper[facei]/heatCapacity_[P];
        source[P] += upper[facei]*temperatureBase_[N];
        source[N] += upper[facei]*temperatureBase_[P];
    }
    const scalarField baseBeyond(shared_.beyond(temperatureBase_));
    const scalarField capacityBeyond(shared_.beyond(heatCapacity_));
    forAll(mesh_.boundary(), patchi)
    {
        const labelUList& cells = mesh_.boundary()[patchi].faceCells();
        const scalarField& own = heat.internalCoeffs()[patchi];
        const scalarField& given = heat.boundaryCoeffs()[patchi];
        if (boundary_.of(patchi) == passage::within)
        {
            // The other rank's cell is a neighbour like any other.
            forAll(cells, i)
            {
                const label celli = cells[i], facei = mesh_.boundary()[patchi].start() + i;
                enthalpy.internalCoeffs()[patchi][i] -= own[i]/heatCapacity_[celli];
                enthalpy.boundaryCoeffs()[patchi][i] -= given[i]/capacityBeyond[facei];
                source[celli] += own[i]*temperatureBase_[celli] - given[i]*baseBeyond[facei];
            }
            continue;
        }
        forAll(cells, i)
        {
            const label celli = cells[i];
            enthalpy.internalCoeffs()[patchi][i] -= own[i]/heatCapacity_[celli];
            enthalpy.boundaryCoeffs()[patchi][i] -= given[i] - own[i]*temperatureBase_[celli];
        }
    }
}
