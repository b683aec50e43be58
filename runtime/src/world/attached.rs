//! Devices around the board: each has a file in `outside/` and a row in [`DEVICES`].
//!
//! A machine file or a stimulus describes one by its name and settings; `machine` keeps it while it is attached.

use kmotiondef::Bit;

use super::outside;
use crate::machine::attached::AttachedDevice;
use chips::kanalog::ADC_CHANNELS;

/// A device that has been described: its name and its settings, in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeviceSpec {
    /// A name of the table of devices.
    pub name: String,
    /// Keys and values.
    pub settings: Vec<(String, String)>,
}

/// A kind of device.
struct Row {
    name: &'static str,
    build: fn(&mut Settings<'_>) -> Result<Box<dyn AttachedDevice>, String>,
}

/// All kinds.
const DEVICES: &[Row] = &[
    // An input follows an output.
    Row { name: "wire", build: |settings| boxed(outside::wire::Wire::new(settings)) },
    // A slave on a synchronous serial bus.
    Row { name: "spi", build: |settings| boxed(outside::spi::Spi::new(settings)) },
    // A low pass on outputs, its voltage on an analog input.
    Row { name: "rc", build: |settings| boxed(outside::rc::Filter::new(settings)) },
    // An encoder turned by outputs.
    Row { name: "quadrature", build: |settings| boxed(outside::quadrature::Quadrature::new(settings)) },
    // The analog output of KStep, on an analog input.
    Row { name: "kstep_analog", build: |settings| boxed(outside::kstep_analog::KStepAnalog::new(settings)) },
    // A resolver excited by an output, its two windings on analog inputs.
    Row { name: "resolver", build: |settings| boxed(outside::resolver::Resolver::new(settings)) },
    // Echoes the characters that the UART sends.
    Row { name: "echo", build: |settings| boxed(outside::echo::Echo::new(settings)) },
    // A slave with registers on the UART.
    Row { name: "modbus", build: |settings| boxed(outside::modbus::Modbus::new(settings)) },
];

fn boxed<T: AttachedDevice + 'static>(device: Result<T, String>) -> Result<Box<dyn AttachedDevice>, String> {
    device.map(|device| Box::new(device) as Box<dyn AttachedDevice>)
}

impl DeviceSpec {
    /// The device.
    ///
    /// # Errors
    /// A name that is not in the table, a setting that is missing, unknown or wrong.
    pub(crate) fn build(&self) -> Result<Box<dyn AttachedDevice>, String> {
        let Some(row) = DEVICES.iter().find(|row| row.name == self.name) else {
            let names: Vec<_> = DEVICES.iter().map(|row| row.name).collect();
            return Err(format!("there is no device `{}`; known: {}", self.name, names.join(", ")));
        };
        let mut settings = Settings { device: row.name, left: self.settings.clone(), known: Vec::new() };
        let device = (row.build)(&mut settings)?;
        match settings.left.first() {
            None => Ok(device),
            Some((key, _)) => Err(format!(
                "device `{}` has no setting `{key}`; it has {}",
                row.name,
                settings.known.join(", ")
            )),
        }
    }
}

/// The settings of a device, taken one by one.
#[derive(Debug)]
pub(crate) struct Settings<'a> {
    device: &'a str,
    left: Vec<(String, String)>,
    known: Vec<&'static str>,
}

impl Settings<'_> {
    /// The value of a key, if it is present.
    fn find(&mut self, key: &'static str) -> Option<String> {
        self.known.push(key);
        let index = self.left.iter().position(|(name, _)| name == key)?;
        Some(self.left.remove(index).1)
    }

    /// A value as `read` understands it.
    pub(crate) fn optional<T>(
        &mut self,
        key: &'static str,
        what: &str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<Option<T>, String> {
        let Some(value) = self.find(key) else { return Ok(None) };
        match read(&value) {
            Some(read) => Ok(Some(read)),
            None => Err(format!("`{key}={value}` of device `{}` is not {what}", self.device)),
        }
    }

    /// A value that must be present.
    fn required<T>(&self, key: &str, value: Option<T>) -> Result<T, String> {
        value.ok_or_else(|| format!("device `{}` needs `{key}=…`", self.device))
    }

    pub(crate) fn optional_bit(&mut self, key: &'static str) -> Result<Option<Bit>, String> {
        self.optional(key, &format!("a bit from 0 to {}", Bit::MAX), |text| Bit::new(text.parse().ok()?))
    }

    pub(crate) fn bit(&mut self, key: &'static str) -> Result<Bit, String> {
        let bit = self.optional_bit(key)?;
        self.required(key, bit)
    }

    pub(crate) fn optional_number(&mut self, key: &'static str) -> Result<Option<f64>, String> {
        self.optional(key, "a number", |text| text.parse().ok().filter(|number: &f64| number.is_finite()))
    }

    pub(crate) fn number(&mut self, key: &'static str, default: f64) -> Result<f64, String> {
        Ok(self.optional_number(key)?.unwrap_or(default))
    }

    /// A number above 0.
    pub(crate) fn positive(&mut self, key: &'static str, default: f64) -> Result<f64, String> {
        let number = self.number(key, default)?;
        let device = self.device;
        if number > 0.0 { Ok(number) } else { Err(format!("`{key}` of device `{device}` must be above 0")) }
    }

    pub(crate) fn flag(&mut self, key: &'static str) -> Result<bool, String> {
        let flag = self.optional(key, "0 or 1", |text| match text {
            "0" | "false" => Some(false),
            "1" | "true" => Some(true),
            _ => None,
        })?;
        Ok(flag.unwrap_or(false))
    }

    /// An analog input.
    pub(crate) fn adc(&mut self, key: &'static str) -> Result<usize, String> {
        let channel = self.optional(key, "an analog input from 0 to 7", |text| {
            text.parse().ok().filter(|&channel| channel < ADC_CHANNELS)
        })?;
        self.required(key, channel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the error message for a device, described as in a stimulus.
    fn wrong(text: &str) -> String {
        let mut words = text.split(' ');
        let name = words.next().unwrap_or_default().to_owned();
        let settings = words.filter_map(|word| word.split_once('='));
        let settings = settings.map(|(key, value)| (key.to_owned(), value.to_owned())).collect();
        DeviceSpec { name, settings }.build().map(|_| ()).expect_err("it is wrong")
    }

    #[test]
    fn wrong_descriptions_say_what_is_wrong() {
        for (text, expect) in [
            (
                "wier from=1 to=2",
                "there is no device `wier`; known: wire, spi, rc, quadrature, kstep_analog, resolver, echo, modbus",
            ),
            ("wire from=1", "device `wire` needs `to=…`"),
            ("wire from=1 to=2048", "`to=2048` of device `wire` is not a bit from 0 to 2047"),
            (
                "wire from=1 to=2 color=3",
                "device `wire` has no setting `color`; it has from, to, invert, delay_s",
            ),
            ("rc high=1 adc=9", "`adc=9` of device `rc` is not an analog input from 0 to 7"),
            ("rc high=1 adc=1 ohms=0", "`ohms` of device `rc` must be above 0"),
        ] {
            assert_eq!(wrong(text), expect, "{text}");
        }
    }
}
