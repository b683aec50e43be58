//! The framing of the board's USB chip. Source: wire.md sections 2.3 and 2.4.

/// The number of status bytes at the beginning of each packet.
const STATUS: usize = 2;

/// A request to the chip: number and value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChipRequest {
    /// Its number.
    pub request: u8,
    /// Its value.
    pub value: u16,
}

/// The time after which an incomplete packet is sent, in milliseconds.
pub const LATENCY: u8 = 2;

/// The requests that prepare the chip, in this order.
pub const PREPARATION: [ChipRequest; 5] = [
    // Reset.
    ChipRequest { request: 0, value: 0 },
    ChipRequest { request: 9, value: LATENCY as u16 },
    // A packet with a line feed is sent at once.
    ChipRequest { request: 6, value: 0x010A },
    // Drop received and unsent data.
    ChipRequest { request: 0, value: 1 },
    ChipRequest { request: 0, value: 2 },
];

/// Appends the data of a transfer to `data`: each packet begins with two status bytes.
pub fn strip(transfer: &[u8], packet_size: usize, data: &mut Vec<u8>) {
    for packet in transfer.chunks(packet_size.max(STATUS + 1)) {
        data.extend_from_slice(packet.get(STATUS..).unwrap_or_default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripped(transfer: &[u8]) -> Vec<u8> {
        let mut data = Vec::new();
        strip(transfer, 64, &mut data);
        data
    }

    /// A transfer with `data`, in the chip's format.
    fn transfer(data: &[u8]) -> Vec<u8> {
        data.chunks(62).flat_map(|part| [&[0x01, 0x60], part].concat()).collect()
    }

    #[test]
    fn recorded_packets_give_their_data() {
        // The answer to the abort byte, and a packet of a chip that has no data (wire.md section 2.3).
        assert_eq!(stripped(&[0x01, 0x60, 0x1B, 0x43, 0x0D]), b"\x1bC\r");
        assert_eq!(stripped(&[0x01, 0x60]), b"");
        assert_eq!(stripped(&[]), b"");
        assert_eq!(stripped(&[0x01]), b"");
    }

    #[test]
    fn status_bytes_are_removed_from_every_packet_of_a_transfer() {
        for length in [1, 61, 62, 63, 124, 125, 496, 500, 3968] {
            let data: Vec<u8> = (0..=255).cycle().take(length).collect();
            assert_eq!(stripped(&transfer(&data)), data, "{length} bytes");
        }
    }

    #[test]
    fn data_that_looks_like_status_bytes_stays() {
        let data = [0x01, 0x60].repeat(62);
        assert_eq!(stripped(&transfer(&data)), data);
    }
}
