//! What a program sets while a run goes on: conditions of the gas, feeds, outlets.
//!
//! A control takes effect at the start of the next window, is logged, and is part of the checkpoint: a resumed run
//! has what was set before. Each condition is kept once, as it was set last.

use super::error::ControlError;
use crate::boundary_value::BoundaryValue;
use crate::feeds::FeedsAndOutlets;

/// Something that is set while a run goes on.
#[derive(Clone, Debug, PartialEq)]
pub enum Control {
    /// A condition of the gas at a patch.
    Boundary(BoundaryValue),
    /// The mass flow of a feed in kg/s of process time.
    FeedRate {
        /// Name of the feed.
        feed: String,
        /// Zero or positive.
        rate: f64,
    },
    /// The temperature in K with which particles of a feed come in.
    FeedTemperature {
        /// Name of the feed.
        feed: String,
        /// Positive.
        temperature: f64,
    },
    /// The mass flow of an outlet in kg/s of process time at most; infinite where everything goes.
    OutletRate {
        /// Name of the outlet.
        outlet: String,
        /// Zero or positive.
        rate: f64,
    },
}

impl Control {
    /// The control as one line that is read back bit for bit.
    pub fn line(&self) -> String {
        match self {
            Self::Boundary(value) => format!("boundary\t{value}"),
            Self::FeedRate { feed, rate } => format!("feed rate\t{feed}\t{rate:?}"),
            Self::FeedTemperature { feed, temperature } => {
                format!("feed temperature\t{feed}\t{temperature:?}")
            }
            Self::OutletRate { outlet, rate } => format!("outlet rate\t{outlet}\t{rate:?}"),
        }
    }

    /// Reads a line back; `None` where it is none.
    pub fn read(line: &str) -> Option<Self> {
        let (kind, rest) = line.split_once('\t')?;
        if kind == "boundary" {
            return BoundaryValue::read(rest).map(Self::Boundary);
        }
        let (name, value) = rest.rsplit_once('\t')?;
        let (name, value) = (name.to_owned(), value.parse().ok()?);
        Some(match kind {
            "feed rate" => Self::FeedRate {
                feed: name,
                rate: value,
            },
            "feed temperature" => Self::FeedTemperature {
                feed: name,
                temperature: value,
            },
            "outlet rate" => Self::OutletRate {
                outlet: name,
                rate: value,
            },
            _ => return None,
        })
    }

    /// True where this takes the place of another control.
    pub(super) fn replaces(&self, other: &Self) -> bool {
        use crate::boundary_value::BoundaryQuantity::{MassFlow, SuperficialVelocity};
        let flows =
            |value: &BoundaryValue| matches!(value.quantity, SuperficialVelocity(_) | MassFlow(_));
        match (self, other) {
            (Self::Boundary(new), Self::Boundary(old)) => {
                let same = new.quantity.name() == old.quantity.name();
                new.patch == old.patch && (same || (flows(new) && flows(old)))
            }
            (Self::FeedRate { feed, .. }, Self::FeedRate { feed: old, .. })
            | (Self::FeedTemperature { feed, .. }, Self::FeedTemperature { feed: old, .. })
            | (Self::OutletRate { outlet: feed, .. }, Self::OutletRate { outlet: old, .. }) => {
                feed == old
            }
            _ => false,
        }
    }

    /// Sets a feed or an outlet; a condition of the gas is none of theirs.
    pub(super) fn apply(&self, feeds: &mut FeedsAndOutlets) -> Result<(), ControlError> {
        let positive = |what, name: &str, value: f64| {
            let wrong = !(value.is_finite() && value > 0.0);
            refuse(wrong, what, name, value, ["K", "positive"])
        };
        let rate_of = |what, name: &str, value: f64, endless: bool| {
            let wrong = !(value >= 0.0 && (value.is_finite() || endless));
            refuse(wrong, what, name, value, ["kg/s", "zero or positive"])
        };
        match self {
            Self::Boundary(_) => {}
            Self::FeedRate { feed, rate } => {
                rate_of("feed", feed, *rate, false)?;
                let list = feeds.feeds.iter_mut().map(|one| (&one.name, &mut one.rate));
                *named("feed", feed, list)? = *rate;
            }
            Self::FeedTemperature { feed, temperature } => {
                positive("feed", feed, *temperature)?;
                let list = feeds.feeds.iter_mut();
                let list = list.map(|one| (&one.name, &mut one.temperature));
                *named("feed", feed, list)? = *temperature;
            }
            Self::OutletRate { outlet, rate } => {
                rate_of("outlet", outlet, *rate, true)?;
                let list = feeds.outlets.iter_mut();
                let list = list.map(|one| (&one.name, &mut one.rate));
                *named("outlet", outlet, list)? = rate.is_finite().then_some(*rate);
            }
        }
        Ok(())
    }
}

fn refuse(
    wrong: bool,
    what: &'static str,
    name: &str,
    value: f64,
    [unit, rule]: [&'static str; 2],
) -> Result<(), ControlError> {
    if !wrong {
        return Ok(());
    }
    Err(ControlError::Value {
        what,
        name: name.to_owned(),
        value,
        unit,
        rule,
    })
}

/// The value of the feed or outlet of a name.
fn named<'a, T>(
    what: &'static str,
    name: &str,
    list: impl Iterator<Item = (&'a String, &'a mut T)>,
) -> Result<&'a mut T, ControlError> {
    let mut present = Vec::new();
    for (own, value) in list {
        if own == name {
            return Ok(value);
        }
        present.push(own.as_str());
    }
    Err(ControlError::NotThere {
        what,
        name: name.to_owned(),
        present: match present.is_empty() {
            true => "none".into(),
            false => present.join(", "),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary_value::BoundaryQuantity;

    fn boundary(quantity: BoundaryQuantity) -> Control {
        Control::Boundary(BoundaryValue {
            patch: "bottom".into(),
            quantity,
        })
    }

    #[test]
    fn every_control_is_read_back_from_its_line() {
        let feed = || "ore from above".to_owned();
        for control in [
            boundary(BoundaryQuantity::Temperature(300.1)),
            Control::FeedRate {
                feed: feed(),
                rate: 0.1 + 0.2,
            },
            Control::FeedTemperature {
                feed: feed(),
                temperature: 295.0,
            },
            Control::OutletRate {
                outlet: feed(),
                rate: f64::INFINITY,
            },
        ] {
            assert_eq!(Control::read(&control.line()), Some(control));
        }
        assert_eq!(Control::read("lid\tx\t1"), None);
    }

    #[test]
    fn a_velocity_takes_the_place_of_a_mass_flow_and_not_of_a_temperature() {
        let velocity = boundary(BoundaryQuantity::SuperficialVelocity(1.0));
        assert!(velocity.replaces(&boundary(BoundaryQuantity::MassFlow(2.0))));
        assert!(!velocity.replaces(&boundary(BoundaryQuantity::Temperature(300.0))));
    }

    #[test]
    fn a_feed_that_is_not_there_is_refused_with_those_that_are() {
        let control = Control::FeedRate {
            feed: "ore".into(),
            rate: 1.0,
        };
        let error = control.apply(&mut FeedsAndOutlets::default()).unwrap_err();
        assert_eq!(error.to_string(), "the run has no feed `ore`; it has none");
    }

    #[test]
    fn rates_below_zero_are_refused() {
        let control = Control::OutletRate {
            outlet: "bottom".into(),
            rate: -1.0,
        };
        assert!(control.apply(&mut FeedsAndOutlets::default()).is_err());
    }
}
